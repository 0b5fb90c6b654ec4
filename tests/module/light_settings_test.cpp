// SPDX-License-Identifier: GPL-2.0-or-later
// The engine's small cvars and pt_min_light: what they do to the light of a room, pixel by pixel.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr uint8_t wall_index = 180;

void expect_colour(const glm::vec3& seen, const glm::vec3& wanted, float tolerance, const std::string& what)
{
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(seen[i], wanted[i], tolerance) << what << ", channel " << i;
}

class LightSettings : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        folder_->add_wall("wall", wall_index);
        folder_->add_wall("red", red_index);
        folder_->add_wall("lamp", red_index);
        folder_->add_cube("cube", 8, white_index);
        MapBuilder dark;
        dark.add(rectangle({ 0, 0, 0 }, { 256, 0, 0 }, { 0, 256, 0 }), dark.add_material("wall"));
        dark.add_room(glm::vec3(-300), glm::vec3(300), dark.add_material("wall"));
        folder_->add_map("dark", dark.finish());
        MapBuilder lit; // by a red lamp
        lit.add(rectangle({ 0, 0, 0 }, { 256, 0, 0 }, { 0, 256, 0 }), lit.add_material("red"));
        lit.add(rectangle({ 0, 0, 200 }, { 0, 16, 0 }, { 16, 0, 0 }), lit.add_material("lamp", 0, 4000));
        folder_->add_map("lit", lit.finish());
        session_ = std::make_unique<Session>(
            *folder_, CvarList { { "pt_bounces", "0" }, { "pt_roughness_default", "1" }, { "pt_exposure", "1" } });
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }
    void SetUp() override
    {
        for (const auto& [name, value] : CvarList { { "pt_min_light", "0" }, { "r_fullbright", "0" },
                 { "r_lightmap", "0" }, { "gl3_colorlight", "1" }, { "r_drawentities", "1" }, { "r_speeds", "0" },
                 { "vk_dynamic", "1" }, { "flt_denoiser", "off" } })
            session_->set(name, value);
    }

    static void load(const std::string& map)
    {
        session_->load_map(map);
        session_->look({ 0, 0, 120 }, { 1, 0, 0 });
    }
    static Radiance picture()
    {
        session_->draw();
        return session_->capture();
    }
    static Radiance picture_with(const engine::DynamicLight& light)
    {
        session_->view.dlights = &light;
        session_->view.dlight_count = 1;
        const Radiance shown = picture();
        session_->view.dlight_count = 0;
        return shown;
    }
    // Where the middle of a pixel sees the floor.
    static glm::vec3 floor_point(int x, int y)
    {
        const CameraRay ray = camera_ray(session_->view, { float(x) + 0.5f, float(y) + 0.5f });
        return ray.origin + ray.direction * (-ray.origin.z / ray.direction.z);
    }

    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
};

TEST_F(LightSettings, LeastLightIsReadFromABlackRoom)
{
    constexpr float least = 0.25f;
    load("dark");
    EXPECT_TRUE(is_black(picture()));
    session_->set("pt_min_light", double(least));
    const glm::vec3 wanted = linear_colour(wall_index) * least;
    for (const char* denoiser : { "off", "temporal", "asvgf" }) {
        session_->set("flt_denoiser", denoiser);
        session_->draw(3);
        const Radiance shown = picture();
        for (const glm::vec3& pixel : shown.pixels)
            expect_colour(pixel, wanted, 0.01f * wanted.x, denoiser);
    }
}

TEST_F(LightSettings, FullbrightShowsThePicturesAndLightAloneTheLight)
{
    load("lit");
    const Radiance plain = picture();
    session_->set("r_fullbright", 1);
    const Radiance bright = picture();
    for (const glm::vec3& pixel : bright.pixels)
        expect_colour(pixel, linear_colour(red_index), 2e-3f, "fullbright");
    session_->set("r_fullbright", 0);
    session_->set("r_lightmap", 1);
    const Radiance light = picture();
    const float red = linear_colour(red_index).x;
    ASSERT_GT(red, 0.1f);
    for (size_t i = 0; i < plain.pixels.size(); i++) // little of the surface's light is specular
        EXPECT_NEAR(light.pixels[i].x * red, plain.pixels[i].x, 0.1f * plain.pixels[i].x) << i;
}

TEST_F(LightSettings, LightCanBeWithoutColour)
{
    load("lit");
    session_->set("r_lightmap", 1);
    const glm::vec3 coloured = picture().mean();
    EXPECT_GT(coloured.x, 4 * coloured.y);
    session_->set("gl3_colorlight", 0);
    const glm::vec3 grey = picture().mean();
    EXPECT_FLOAT_EQ(grey.x, grey.y);
    EXPECT_FLOAT_EQ(grey.x, grey.z);
    EXPECT_NEAR(grey.x, luminance(coloured), 0.01f * grey.x);
}

// Colour * (intensity - distance), in units of which 128 are a radiance of 1; never below black.
TEST_F(LightSettings, NegativeLightsTakeLightAway)
{
    load("dark");
    session_->set("pt_min_light", 0); // which comes on top
    const engine::DynamicLight light { { 20, 0, 40 }, { 1, 1, 1 }, 300 };
    engine::DynamicLight dark = light;
    std::ranges::fill(dark.color, -0.4f);
    EXPECT_TRUE(is_black(picture_with(dark)));
    load("lit");
    const Radiance before = picture();
    const float albedo = linear_colour(red_index).x;
    // Half of the light, where most is taken.
    const float strength = 0.5f * before.mean().x / albedo * 128 / 300;
    std::ranges::fill(dark.color, -strength);
    const Radiance after = picture_with(dark);
    int dimmed = 0;
    for (int y = 0; y < before.height; y++)
        for (int x = 0; x < before.width; x++) {
            const glm::vec3 point = floor_point(x, y);
            const float distance = glm::distance(point, glm::vec3(20, 0, 40));
            const float taken = albedo * strength / 128 * std::max(0.0f, 300 - distance);
            const float wanted = before.at(x, y).x - taken;
            if (wanted > 0.2f * before.at(x, y).x) { // the specular part stays
                dimmed++;
                EXPECT_NEAR(after.at(x, y).x, wanted, 0.02f * before.at(x, y).x) << x << " " << y;
            } else {
                EXPECT_LE(after.at(x, y).x, 0.2f * before.at(x, y).x + 1e-4f) << x << " " << y;
            }
        }
    EXPECT_GT(dimmed, 100);
}

TEST_F(LightSettings, DynamicLightsCanBeOff)
{
    load("dark");
    const engine::DynamicLight light { { 20, 0, 40 }, { 1, 1, 1 }, 300 };
    EXPECT_FALSE(is_black(picture_with(light)));
    session_->set("vk_dynamic", 0);
    EXPECT_TRUE(is_black(picture_with(light)));
}

TEST_F(LightSettings, TheMapCanBeShownAlone)
{
    load("lit");
    const Radiance empty = picture();
    const engine::Entity cube = make_entity(session_->module().register_model("models/cube.md2"), { 0, 0, 30 });
    ASSERT_TRUE(cube.model);
    session_->view.entities = &cube;
    session_->view.entity_count = 1;
    EXPECT_FALSE(picture() == empty);
    session_->set("r_drawentities", 0);
    EXPECT_TRUE(picture() == empty);
    session_->view.entity_count = 0;
}

TEST_F(LightSettings, SpeedsArePrintedEveryFrame)
{
    load("lit");
    session_->draw();
    EXPECT_FALSE(session_->has_line("lights"));
    session_->set("r_speeds", 1);
    session_->draw();
    EXPECT_TRUE(session_->has_line("     4 triangles      0 of models     2 lights"));
}

} // namespace
} // namespace vkpt::tests
