// SPDX-License-Identifier: GPL-2.0-or-later
// pt_wipe: baked lightmaps in a part of the picture.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr float half = 64;
const glm::vec3 lift_place { 300, 40, 24 };

// A face's lightmap is what `luxel` tells of each of its luxels' columns, by lightstyle.
template <typename F> void bake(formats::Bsp& bsp, size_t face, const std::vector<uint8_t>& styles, F luxel)
{
    const glm::ivec2 size = bsp.lightmap_extent(face).size;
    std::ranges::copy(styles, bsp.faces[face].styles);
    bsp.faces[face].light_offset = int(bsp.lighting.size());
    for (const uint8_t style : styles)
        for (int y = 0; y < size.y; y++)
            for (int x = 0; x < size.x; x++)
                for (int i = 0; i < 3; i++)
                    bsp.lighting.push_back(uint8_t(luxel(style, x, i)));
}

class ClassicLight : public testing::Test {
protected:
    // A floor whose lightmap is bright where x is small, blue in a second lightstyle, and that no light reaches. A lift
    // of the same size whose lightmap is bright where its own x is large.
    ClassicLight()
    {
        folder_.add_wall("wall", white_index);
        folder_.add_cube("cube", 8, white_index);
        MapBuilder map;
        const uint16_t wall = map.add_material("wall");
        const Polygon square = rectangle({ 0, 0, 0 }, { half, 0, 0 }, { 0, half, 0 });
        map.add(square, wall);
        map.begin_brush_model();
        map.add(square, wall);
        formats::Bsp bsp = map.finish();
        bake(bsp, 0, { 0, 5 }, [](int style, int x, int i) { return style == 0 ? 128 - 16 * x : i == 2 ? 64 : 0; });
        bake(bsp, 1, { 0 }, [](int, int x, int) { return 16 + 8 * x; });
        folder_.add_map("baked", bsp);
        session_ = std::make_unique<Session>(folder_, CvarList { { "pt_accumulate", "1" }, { "pt_wipe", "1" } });
        session_->load_map("baked");
        session_->light_style(5, 0);
    }
    ~ClassicLight() override { session_->view.dlight_count = session_->view.entity_count = 0; }
    void show(const std::vector<engine::Entity>& entities)
    {
        entities_ = entities;
        session_->view.entities = entities_.data();
        session_->view.entity_count = int(entities_.size());
    }
    void shine(const std::vector<engine::DynamicLight>& lights)
    {
        lights_ = lights;
        session_->view.dlights = lights_.data();
        session_->view.dlight_count = int(lights_.size());
    }
    engine::Entity entity(const char* model, glm::vec3 origin)
    {
        return make_entity(session_->module().register_model(model), origin);
    }
    glm::vec3 seen_at(float x, float y = 0)
    {
        session_->look({ x, y, 200 }, { x + 0.01f, y, 0 }, 1);
        session_->extension().thaw_scene();
        session_->draw(2);
        return session_->capture().mean();
    }
    const float white_ = linear_colour(white_index).y;

    GameFolder folder_;
    std::unique_ptr<Session> session_;
    std::vector<engine::Entity> entities_;
    std::vector<engine::DynamicLight> lights_;
};

TEST_F(ClassicLight, IsTheLightmapsTimesThePicture)
{
    for (const float x : { -60.0f, -40.0f, 0.0f, 24.0f })
        EXPECT_NEAR(seen_at(x).y, white_ * (128 - (x + 64)) / 128, 0.01f) << x;
    session_->light_style(5, 2);
    const glm::vec3 blue = seen_at(0);
    EXPECT_NEAR(blue.y, 0.5f * white_, 0.01f);
    EXPECT_NEAR(blue.z, 1.5f * white_, 0.02f);
}

// Not those of a lift that they stand on.
TEST_F(ClassicLight, ModelsGetTheFloors)
{
    show({ entity("models/cube.md2", { 32, 0, 60 }) });
    EXPECT_NEAR(seen_at(32).y, 0.25f * white_, 0.02f);
    show({ entity("models/cube.md2", { 32, 0, 60 }), entity("*1", { 32, 0, 30 }) });
    EXPECT_NEAR(seen_at(32).y, 0.25f * white_, 0.02f);
}

TEST_F(ClassicLight, LiftsKeepTheirLightmaps)
{
    engine::Entity lift = entity("*1", lift_place);
    for (const float yaw : { 0.0f, 90.0f, -30.0f }) {
        lift.angles[1] = yaw;
        show({ lift });
        for (const float along : { -50.0f, 0.0f, 56.0f }) { // the lift's own x
            const float angle = glm::radians(yaw);
            const glm::vec3 seen
                = seen_at(lift_place.x + along * std::cos(angle), lift_place.y + along * std::sin(angle));
            EXPECT_NEAR(seen.y, white_ * (16 + 0.5f * (along + half)) / 128, 0.01f) << yaw << ", " << along;
        }
    }
    lift.angles[2] = 180; // seen from behind: its faces have one side, and rays meet both
    lift.angles[1] = 0;
    show({ lift });
    EXPECT_NEAR(seen_at(lift_place.x + 40, lift_place.y).y, white_ * (16 + 0.5f * (40 + half)) / 128, 0.01f);
}

// Lightmap values that gl3 adds for a light above a surface.
float added_by_gl3(float intensity, float height, float beside)
{
    constexpr float margin = 52, lift = 32;
    const float reach = std::max(intensity - std::hypot(height, beside) - margin, 0.0f);
    return reach * (height + lift) / std::hypot(height + lift, beside);
}

TEST_F(ClassicLight, DynamicLightsBrightenAsInGl3)
{
    constexpr float intensity = 220, height = 80;
    const glm::vec3 colour { 0.25f, 1, 0.5f };
    const float x = 40, base = 128 - (x + half);
    for (const float beside : { 0.0f, 30.0f, -60.0f }) {
        shine({ { { x + beside, 0, height }, { colour.x, colour.y, colour.z }, intensity } });
        const glm::vec3 seen = seen_at(x);
        const float added = added_by_gl3(intensity, height, beside);
        for (int i = 0; i < 3; i++)
            EXPECT_NEAR(seen[i], white_ * (base + added * colour[i]) / 128, 0.01f) << beside << ", " << i;
    }
    shine({ { { x, 0, -20 }, { 1, 1, 1 }, intensity } });
    EXPECT_NEAR(seen_at(x).y, white_ * base / 128, 0.01f) << "from behind";
    shine({ { { x, 0, 170 }, { 1, 1, 1 }, intensity } });
    EXPECT_NEAR(seen_at(x).y, white_ * base / 128, 0.01f) << "within its intensity, but not within gl3's margin";
}

TEST_F(ClassicLight, NegativeLightsDarken)
{
    constexpr float height = 40, intensity = 132;
    const float x = 0, base = 128 - (x + half), taken = added_by_gl3(intensity, height, 0);
    shine({ { { x, 0, height }, { -1, -0.5f, -4 }, intensity } });
    const glm::vec3 seen = seen_at(x);
    EXPECT_NEAR(seen.x, white_ * (base - taken) / 128, 0.01f);
    EXPECT_NEAR(seen.y, white_ * (base - 0.5f * taken) / 128, 0.01f);
    EXPECT_NEAR(seen.z, 0, 0.001f) << "never below black";
    shine({ { { x, 0, height }, { -1, -1, -1 }, intensity }, { { x, 0, height }, { 1, 1, 1 }, intensity } });
    EXPECT_NEAR(seen_at(x).y, white_ * base / 128, 0.01f) << "both at once";
}

TEST_F(ClassicLight, DynamicLightsReachLiftsAndModels)
{
    constexpr float intensity = 150, height = 60;
    show({ entity("*1", lift_place) });
    shine({ { { lift_place.x, lift_place.y, lift_place.z + height }, { 1, 1, 1 }, intensity } });
    EXPECT_NEAR(seen_at(lift_place.x, lift_place.y).y,
        white_ * (16 + 0.5f * half + added_by_gl3(intensity, height, 0)) / 128, 0.01f);
    const float top = 68;
    show({ entity("models/cube.md2", { 32, 0, 60 }) });
    shine({ { { 32, 0, top + 120 }, { 1, 1, 1 }, intensity } });
    EXPECT_NEAR(seen_at(32).y, white_ * (32 + intensity - 120) / 128, 0.03f) << "whatever their faces' angle";
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
