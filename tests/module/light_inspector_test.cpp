// SPDX-License-Identifier: GPL-2.0-or-later
// The command pt_lights: what it lists under the crosshair, and that muted lights neither light nor shine.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <regex>

namespace vkpt::tests {
namespace {

// A floor under a bright lamp of two triangles, a dimmer lamp beside it and a point light.
class LightInspection : public testing::Test {
protected:
    LightInspection()
    {
        folder_.add_wall("floor", white_index);
        for (const char* name : { "bright", "dim" })
            folder_.add_wall(name, white_index);
        MapBuilder map;
        map.add(rectangle({ 0, 0, 0 }, { 200, 0, 0 }, { 0, 200, 0 }), map.add_material("floor"));
        const uint16_t bright = map.add_material("bright", formats::SURF_LIGHT, 900);
        const uint16_t dim = map.add_material("dim", formats::SURF_LIGHT, 300);
        map.add(rectangle({ 0, 0, 100 }, { 0, 16, 0 }, { 16, 0, 0 }), bright);
        map.add(rectangle({ 60, 0, 100 }, { 0, 16, 0 }, { 16, 0, 0 }), dim);
        map.add_point_light({ -60, 0, 100 }, 150);
        folder_.add_map("lamps", map.finish());
        start("lamps");
        session_->look({ 0, 0, 60 }, { 1, 0, 0 }, 20);
        session_->draw();
    }

    void start(const std::string& map)
    {
        session_ = nullptr;
        session_
            = std::make_unique<Session>(folder_, CvarList { { "pt_bounces", "0" }, { "pt_roughness_default", "1" } });
        session_->load_map(map);
    }

    std::vector<std::string> run(const std::string& command)
    {
        const size_t before = session_->lines().size();
        session_->host().run_text(command + "\n");
        return { session_->lines().begin() + std::ptrdiff_t(before), session_->lines().end() };
    }

    // The number of the row that says so; 0: none does.
    int find_row(const std::string& what)
    {
        for (const std::string& line : run("pt_lights")) {
            std::smatch match;
            if (std::regex_search(line, match, std::regex("^ *([0-9]+) .*" + what)))
                return std::stoi(match[1]);
        }
        return 0;
    }

    double light_on_floor()
    {
        session_->draw();
        const std::vector<IrradianceProbe> probes(64, { { 0, 0, 0 }, { 0, 0, 1 } });
        double sum = 0;
        for (const glm::vec3& measured : session_->probe(probes, 64))
            sum += double(measured.y) / double(probes.size());
        return sum;
    }

    double seen_at(glm::vec3 target)
    {
        session_->look({ 0, 0, 60 }, target, 5);
        session_->draw();
        const double seen = double(session_->capture().mean().y);
        session_->look({ 0, 0, 60 }, { 1, 0, 0 }, 20);
        session_->draw();
        return seen;
    }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
};

TEST_F(LightInspection, ListsWholeLampsTheLikeliestFirst)
{
    const std::vector<std::string> lines = run("pt_lights");
    ASSERT_EQ(lines.size(), 6u);
    EXPECT_NE(lines[0].find("3 lights in 5 emitters"), std::string::npos) << lines[0];
    EXPECT_EQ(find_row("lamp .*bright"), 1);
    EXPECT_GT(find_row("lamp .*dim"), 1);
    EXPECT_GT(find_row("point light"), 1);
    double chosen = 0, share = 0;
    for (size_t i = 3; i < lines.size(); i++) {
        std::smatch match;
        ASSERT_TRUE(std::regex_search(lines[i], match, std::regex("([0-9.]+)% +([0-9.]+)% +([0-9]+) "))) << lines[i];
        chosen += std::stod(match[1]);
        share += std::stod(match[2]);
    }
    EXPECT_NEAR(chosen, 100, 1);
    EXPECT_NEAR(share, 100, 0.1);
}

TEST_F(LightInspection, MutedLightsNeitherLightNorShine)
{
    const double all = light_on_floor(), bright_seen = seen_at({ 0, 0, 100 });
    EXPECT_GT(bright_seen, 8);
    const int bright = find_row("bright");
    run("pt_lights mute " + std::to_string(bright));
    const double rest = light_on_floor();
    EXPECT_LT(seen_at({ 0, 0, 100 }), 0.05) << "it is only lit by the others";
    EXPECT_GT(seen_at({ 60, 0, 100 }), 2) << "the other lamp still shines";
    EXPECT_NE(run("pt_lights").front().find("muted: 1"), std::string::npos);
    run("pt_lights all");
    EXPECT_NEAR(light_on_floor(), all, 0.01 * all);
    EXPECT_NEAR(seen_at({ 0, 0, 100 }), bright_seen, 1e-3);
    run("pt_lights solo " + std::to_string(find_row("bright")));
    EXPECT_NEAR(light_on_floor(), all - rest, 0.02 * all);
    EXPECT_LT(seen_at({ 60, 0, 100 }), 0.05);
    session_->load_map("lamps"); // forgets it
    session_->look({ 0, 0, 60 }, { 1, 0, 0 }, 20);
    EXPECT_NEAR(light_on_floor(), all, 0.01 * all);
}

// Suns are in no face of the map.
TEST_F(LightInspection, SunsAreMutedAsLampsAre)
{
    folder_.add_wall("sky", white_index);
    MapBuilder map;
    map.add_entity({ { "classname", "worldspawn" }, { "_sun_light", "128" }, { "_sun_color", "1 1 1" },
        { "_sun2_light", "64" }, { "_sun2_color", "1 1 1" }, { "_sun2_angle", "0 -60" } });
    map.add_room({ -500, -500, -100 }, { 500, 500, 500 }, map.add_material("sky", formats::SURF_SKY));
    map.add(rectangle({ 0, 0, 0 }, { 200, 0, 0 }, { 0, 200, 0 }), map.add_material("floor"));
    map.add_point_light({ -60, 0, 100 }, 150);
    folder_.add_map("sunny", map.finish());
    start("sunny");
    session_->set("pt_sky_scale", 0);
    session_->look({ 0, 0, 60 }, { 1, 0, 0 }, 20);
    const double all = light_on_floor();
    const int brightest = find_row("sun");
    ASSERT_GT(brightest, 0);
    EXPECT_NE(run("pt_lights mute " + std::to_string(brightest)).front().find("sun is muted"), std::string::npos);
    EXPECT_NEAR(light_on_floor(), all - 1, 0.02);
    EXPECT_NE(run("pt_lights").front().find("muted: 1"), std::string::npos);
    run("pt_lights solo " + std::to_string(find_row("point light")));
    EXPECT_NEAR(light_on_floor(), all - 1 - 0.5 * std::sin(M_PI / 3), 0.02);
    run("pt_lights all");
    EXPECT_NEAR(light_on_floor(), all, 0.02);
    run("pt_lights solo " + std::to_string(find_row("sun")));
    EXPECT_NEAR(light_on_floor(), 1, 0.02);
}

// Averaged images and photo mode's keep a scene.
TEST_F(LightInspection, MutesInScenesThatStandStill)
{
    constexpr int samples = 16;
    const auto see = [&] {
        session_->draw(samples);
        EXPECT_EQ(session_->extension().accumulated_frames(), uint32_t(samples));
        return double(session_->capture().mean().y);
    };
    const auto mute_and_compare = [&] {
        session_->draw(2);
        const int bright = find_row("bright");
        run("pt_lights all");
        const double all = see();
        run("pt_lights mute " + std::to_string(bright));
        EXPECT_LT(see(), 0.8 * all);
        run("pt_lights all");
        EXPECT_EQ(see(), all);
    };
    session_->set("pt_accumulate", 1);
    mute_and_compare();
    session_->set("pt_accumulate", 0);
    session_->draw();
    run("pt_photo");
    for (int i = 0; i < 10000 && session_->extension().accumulated_frames() < 2; i++)
        session_->draw(); // until its camera has come to rest
    mute_and_compare();
    run("pt_photo off");
}

TEST_F(LightInspection, SaysWhatItCannotDo)
{
    run("pt_lights");
    for (const char* wrong : { "pt_lights mute 9", "pt_lights mute 0", "pt_lights solo x", "pt_lights mute 1e9" })
        EXPECT_NE(run(wrong).front().find("is no row of the last list"), std::string::npos) << wrong;
    for (const char* wrong : { "pt_lights mute", "pt_lights dim 1", "pt_lights all 1" })
        EXPECT_NE(run(wrong).front().find("usage"), std::string::npos) << wrong;
    session_->look({ 0, 0, 60 }, { 5000, 0, 60 }, 5); // where nothing is
    session_->draw();
    const std::string line = run("pt_lights").front();
    EXPECT_NE(line.find("no lit surface"), std::string::npos) << line;
}

} // namespace
} // namespace vkpt::tests
