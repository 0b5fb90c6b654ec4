// SPDX-License-Identifier: GPL-2.0-or-later
// What the samplers are for: less error at one sample per pixel.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <numeric>

namespace vkpt::tests {
namespace {

const CvarList direct_light { { "pt_accumulate", "1" }, { "pt_bounces", "0" } };

void use_sampler(Session& session, const std::string& name, int subset)
{
    session.set("pt_light_sampler", name);
    session.set("pt_light_subset", subset);
}

Radiance draw_average(Session& session, int seed, int frames)
{
    session.set("pt_seed", seed);
    session.draw(frames);
    return session.capture();
}

// Root mean square error of pictures of one sample per pixel, relative to the reference's mean.
double measure_error(Session& session, const Radiance& reference)
{
    constexpr int pictures = 12;
    double sum = 0;
    for (int seed = 1; seed <= pictures; seed++) {
        const Radiance picture = draw_average(session, seed, 1);
        for (size_t i = 0; i < picture.pixels.size(); i++) {
            const double error = double(luminance(picture.pixels[i]) - luminance(reference.pixels[i]));
            sum += error * error / double(picture.pixels.size()) / pictures;
        }
    }
    return std::sqrt(sum) / double(luminance(reference.mean()));
}

class SamplerError : public testing::Test {
protected:
    SamplerError()
    {
        folder_.add_wall("wall", 170);
        folder_.add_wall("lamp", white_index);
    }

    void start(MapBuilder& map, const CvarList& more)
    {
        folder_.add_map("scene", map.finish());
        CvarList cvars = direct_light;
        cvars.insert(cvars.end(), more.begin(), more.end());
        session_ = std::make_unique<Session>(folder_, cvars);
        session_->load_map("scene");
    }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
};

// Lamps of very different brightness all over a ceiling.
TEST_F(SamplerError, FallsWithTheLengthOfTheSubset)
{
    MapBuilder map;
    map.add_room({ -256, -256, 0 }, { 256, 256, 160 }, map.add_material("wall"));
    const uint16_t lamps[]
        = { map.add_material("lamp", 0, 50), map.add_material("lamp", 0, 500), map.add_material("lamp", 0, 5000) };
    for (int i = 0; i < 64; i++)
        map.add(rectangle({ float(i % 8) * 60 - 210, float(i / 8) * 60 - 210, 150 }, { 0, 6, 0 }, { 6, 0, 0 }),
            lamps[i * 7 % 3]);
    start(map, { { "pt_roughness_default", "1" } });
    session_->look({ 0, -40, 100 }, { 0, 0, 0 }); // no lamp in sight: the edges' error would drown the lights'
    use_sampler(*session_, "full", 8);
    const Radiance reference = draw_average(*session_, 1000, 256);
    const double full = measure_error(*session_, reference);
    for (const char* name : { "subset", "subset_onesweep", "subset_strides", "subset_mis", "ris" }) {
        double before = 1e9;
        for (const int subset : { 1, 8, 64 }) {
            use_sampler(*session_, name, subset);
            const double error = measure_error(*session_, reference);
            RecordProperty(std::string(name) + "_" + std::to_string(subset), std::to_string(error));
            EXPECT_LT(error, 0.97 * before) << name << ", subset " << subset;
            EXPECT_GT(error, 0.8 * full) << name << ", subset " << subset;
            before = error;
        }
    }
}

// A flash among lamps: of the whole list's eight subsets one holds it.
TEST_F(SamplerError, FallsWhereDynamicLightsHaveASubsetOfTheirOwn)
{
    MapBuilder map;
    map.add_room({ -256, -256, 0 }, { 256, 256, 160 }, map.add_material("wall"));
    const uint16_t lamp = map.add_material("lamp", 0, 50);
    for (int i = 0; i < 64; i++)
        map.add(rectangle({ float(i % 8) * 60 - 210, float(i / 8) * 60 - 210, 150 }, { 0, 6, 0 }, { 6, 0, 0 }), lamp);
    start(map, { { "pt_roughness_default", "1" } });
    session_->look({ 0, -40, 100 }, { 0, 0, 0 });
    const auto draw = [&](const char* sampler) {
        use_sampler(*session_, sampler, 8);
        return draw_average(*session_, 1, 1);
    };
    EXPECT_EQ(draw("subset_dynamic"), draw("subset")); // without dynamic lights they are one

    const engine::DynamicLight flash { { 30, 20, 40 }, { 1, 0.8f, 0.3f }, 300 };
    session_->view.dlights = &flash;
    session_->view.dlight_count = 1;
    session_->extension().thaw_scene();
    use_sampler(*session_, "full", 8);
    const Radiance reference = draw_average(*session_, 1000, 256);
    use_sampler(*session_, "subset", 8);
    const double together = measure_error(*session_, reference);
    use_sampler(*session_, "subset_dynamic", 8);
    const double apart = measure_error(*session_, reference);
    RecordProperty("together", std::to_string(together));
    RecordProperty("apart", std::to_string(apart));
    EXPECT_LT(apart, 0.5 * together);
    EXPECT_GT(apart, 0);
}

// With and without MIS, all else equal.
void expect_mis_to_help(Session& session, double most)
{
    use_sampler(session, "subset_mis", 8);
    const Radiance reference = draw_average(session, 1000, 1024);
    const double with = measure_error(session, reference);
    use_sampler(session, "subset_strides", 8);
    const double without = measure_error(session, reference);
    testing::Test::RecordProperty("with_mis", std::to_string(with));
    testing::Test::RecordProperty("without_mis", std::to_string(without));
    EXPECT_LT(with, most * without);
    EXPECT_GT(with, 0);
}

// Long lamps right above the floor, seen from the side, and others farther off.
TEST_F(SamplerError, MisHelpsNearEmitters)
{
    MapBuilder map;
    map.add_room({ -200, -200, 0 }, { 200, 200, 160 }, map.add_material("wall"));
    const uint16_t lamp = map.add_material("lamp", 0, 300), far_lamp = map.add_material("lamp", 0, 900);
    for (const float y : { -40.0f, 40.0f })
        map.add(rectangle({ 0, y, 3 }, { 0, 6, 0 }, { 120, 0, 0 }), lamp);
    for (int i = 0; i < 16; i++)
        map.add(
            rectangle({ float(i % 4) * 80 - 120, float(i / 4) * 80 - 120, 150 }, { 0, 5, 0 }, { 5, 0, 0 }), far_lamp);
    start(map, { { "pt_roughness_default", "1" }, { "pt_light_point", "area" } });
    session_->look({ 0, -150, 40 }, { 0, 0, 0 });
    expect_mis_to_help(*session_, 0.7);
}

// A brushed metal floor: points of one lamp reflect very differently.
TEST_F(SamplerError, MisHelpsOnGlossySurfaces)
{
    MapBuilder map;
    map.add_room({ -200, -200, 0 }, { 200, 200, 160 }, map.add_material("wall"));
    const uint16_t lamp = map.add_material("lamp", 0, 300);
    for (int i = 0; i < 6; i++)
        map.add(rectangle({ 195, float(i) * 60 - 150, 60 }, { 0, 0, 30 }, { 0, 20, 0 }), lamp); // face -x
    start(map, { { "pt_roughness_default", "0.2" }, { "pt_metallic_default", "1" } });
    session_->look({ -150, 0, 60 }, { 80, 0, 0 });
    expect_mis_to_help(*session_, 0.5);
}

// Our own map, with bounces, sky, models and all: the mean picture of every unbiased sampler.
TEST(SamplersOnOurMap, HaveOneMean)
{
    const std::filesystem::path game = VKPT_GAME_FOLDER;
    if (!std::filesystem::exists(game / "baseq2/maps/vkpt1.bsp"))
        FAIL() << "the build has made no game data: build the target game_data";
    constexpr int runs = 48, frames = 8;
    Session session(game, { { "pt_accumulate", "1" } }, { 48, 32 });
    session.load_map("vkpt1");
    session.look({ 0, -384, 54 }, { 0, 0, 40 });
    const auto measure = [&](const std::string& name) {
        session.set("pt_light_sampler", name);
        std::array<double, runs> means {};
        for (int run = 0; run < runs; run++)
            means[size_t(run)] = double(luminance(draw_average(session, run + 1, frames).mean()));
        return means;
    };
    const std::array<double, runs> reference = measure("full");
    const double reference_mean = std::accumulate(reference.begin(), reference.end(), 0.0) / runs;
    for (const std::string& name : unbiased_samplers(session.extension().info())) {
        if (name == "full")
            continue;
        // Paired by seed: pixels, bounces and points are the same, so that the difference is less noisy than either.
        const std::array<double, runs> means = measure(name);
        double sum = 0, squares = 0;
        for (size_t run = 0; run < runs; run++) {
            const double difference = means[run] - reference[run];
            sum += difference;
            squares += difference * difference;
        }
        const double mean = sum / runs, sigma = std::sqrt((squares / runs - mean * mean) / (runs - 1));
        EXPECT_NEAR(mean, 0, 4 * sigma) << name;
        EXPECT_LT(sigma, 0.015 * reference_mean) << name;
    }
}

} // namespace
} // namespace vkpt::tests
