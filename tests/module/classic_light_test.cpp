// SPDX-License-Identifier: GPL-2.0-or-later
// pt_wipe: baked lightmaps in a part of the picture.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr float half = 64;

class ClassicLight : public testing::Test {
protected:
    // A floor whose lightmap is bright where x is small, blue in a second lightstyle, and that no light reaches.
    ClassicLight()
    {
        folder_.add_wall("wall", white_index);
        folder_.add_cube("cube", 8, white_index);
        MapBuilder map;
        map.add(rectangle({ 0, 0, 0 }, { half, 0, 0 }, { 0, half, 0 }), map.add_material("wall"));
        formats::Bsp bsp = map.finish();
        const formats::Bsp::LightmapExtent extent = bsp.lightmap_extent(0);
        bsp.faces[0].styles[0] = 0;
        bsp.faces[0].styles[1] = 5;
        bsp.faces[0].light_offset = 0;
        for (const int style : { 0, 1 })
            for (int y = 0; y < extent.size.y; y++)
                for (int x = 0; x < extent.size.x; x++)
                    for (int i = 0; i < 3; i++)
                        bsp.lighting.push_back(style == 0 ? uint8_t(128 - 16 * x) : uint8_t(i == 2 ? 64 : 0));
        folder_.add_map("baked", bsp);
        session_ = std::make_unique<Session>(folder_, CvarList { { "pt_accumulate", "1" }, { "pt_wipe", "1" } });
        session_->load_map("baked");
        session_->light_style(5, 0);
    }
    glm::vec3 seen_at(float x)
    {
        session_->look({ x, 0, 200 }, { x + 0.01f, 0, 0 }, 1);
        session_->extension().thaw_scene();
        session_->draw(2);
        return session_->capture().mean();
    }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
};

TEST_F(ClassicLight, IsTheLightmapsTimesThePicture)
{
    const float white = linear_colour(white_index).y;
    for (const float x : { -60.0f, -40.0f, 0.0f, 24.0f })
        EXPECT_NEAR(seen_at(x).y, white * (128 - (x + 64)) / 128, 0.01f) << x;
    session_->light_style(5, 2);
    const glm::vec3 blue = seen_at(0);
    EXPECT_NEAR(blue.y, 0.5f * white, 0.01f);
    EXPECT_NEAR(blue.z, 1.5f * white, 0.02f);
}

TEST_F(ClassicLight, ModelsGetTheFloors)
{
    const engine::Entity cube = make_entity(session_->module().register_model("models/cube.md2"), { 32, 0, 60 });
    session_->view.entities = &cube;
    session_->view.entity_count = 1;
    EXPECT_NEAR(seen_at(32).y, 0.25f * linear_colour(white_index).y, 0.02f);
}

// Paths to the right of the divider: here it is dark.
TEST_F(ClassicLight, EndsAtTheDivider)
{
    session_->set("pt_wipe", 0.5);
    session_->look({ 0, 0, 40 }, { 0.01f, 0, 0 }, 60);
    session_->draw(2);
    const Radiance picture = session_->capture();
    EXPECT_GT(luminance(picture.mean({ 0, 0 }, { 32, 48 })), 0.2f);
    EXPECT_EQ(luminance(picture.mean({ 32, 0 }, { 64, 48 })), 0);
}

// In the window, but not in what is captured of the light.
TEST_F(ClassicLight, ShowsTheDivider)
{
    constexpr int column = 16;
    session_->look({ 0, 0, 40 }, { 0.01f, 0, 0 }, 60);
    const auto window_with = [&](double wipe) {
        session_->set("pt_wipe", wipe);
        session_->draw(2);
        return session_->capture_display();
    };
    const formats::Image all = window_with(1), quarter = window_with(0.25), half_of_it = window_with(0.5);
    for (int y = 0; y < quarter.height; y++) {
        EXPECT_EQ(quarter.at(column, y), quarter.at(column, 0)) << y;
        EXPECT_NE(quarter.at(column, y), all.at(column, y)) << y;
        EXPECT_NE(quarter.at(column, y), half_of_it.at(column, y)) << "elsewhere, " << y;
        EXPECT_EQ(quarter.at(column, y), half_of_it.at(2 * column, y)) << y;
    }
}

// The fast way to draw: no bounces, no shadows, no filter but anti-aliasing. One more ray a pixel finds its face.
TEST_F(ClassicLight, TracesNoPaths)
{
    session_->set("pt_accumulate", 0);
    session_->set("flt_denoiser", "asvgf");
    session_->set("pt_times", 1);
    session_->set("pt_count_rays", 1);
    session_->look({ 0, 0, 60 }, { 0.01f, 0, 0 }, 60);
    session_->draw(8);
    EXPECT_LE(session_->extension().info().visibility_rays, 1024u) << "but those of the light level";
    const uint64_t pixels = uint64_t(session_->view.width) * uint64_t(session_->view.height);
    EXPECT_GE(session_->extension().info().nearest_rays, pixels);
    EXPECT_LE(session_->extension().info().nearest_rays, 2 * pixels + 1024);
    const std::vector<std::string> passes = session_->timed_passes();
    const auto ran = [&](const char* name) { return std::ranges::find(passes, name) != passes.end(); };
    EXPECT_TRUE(ran("classic_light"));
    for (const char* pass : { "replay_samples", "denoise_temporal", "denoise_filter" })
        EXPECT_FALSE(ran(pass)) << pass;
}

} // namespace
} // namespace vkpt::tests
