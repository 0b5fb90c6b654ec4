// SPDX-License-Identifier: GPL-2.0-or-later
// Where the filters keep what the last frames showed, and where they drop it.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr float prism_half = 2, wall_distance = 500;
constexpr int left_style = 1, right_style = 2;

class History : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = std::make_unique<GameFolder>();
        folder_->add_wall("wall", 180);
        cube_path_ = folder_->add_cube("cube", prism_half, red_index);
        // Two halls side by side, each with a lamp of its own.
        MapBuilder halls;
        halls.add_room({ -256, -256, 0 }, { 256, 256, 256 }, halls.add_material("wall"));
        halls.add_block({ -200, -4, 1 }, { 255, 4, 255 }, halls.add_material("wall"));
        halls.add_point_light({ 0, 120, 200 }, 300, left_style);
        halls.add_point_light({ 0, -120, 200 }, 300, right_style);
        folder_->add_map("halls", halls.finish());
        MapBuilder wall;
        wall.add(rectangle({ wall_distance, 0, 0 }, { 0, -300, 0 }, { 0, 0, 300 }), wall.add_material("wall"));
        wall.add_point_light({ 300, 0, 0 }, 400);
        folder_->add_map("wall", wall.finish());
        session_ = std::make_unique<Session>(
            *folder_, CvarList { { "pt_seed", "0" }, { "pt_bounces", "0" } }, glm::ivec2(160, 120));
    }
    static void TearDownTestSuite()
    {
        session_.reset();
        folder_.reset();
    }
    void SetUp() override
    {
        for (const auto& [name, value] :
            CvarList { { "flt_denoiser", "off" }, { "flt_taa", "off" }, { "pt_debug_view", "off" } })
            session_->set(name, value);
        for (const int style : { 0, left_style, right_style })
            session_->light_style(size_t(style), 1);
        session_->view.view_angles[2] = 0;
        session_->view.time = 1;
    }

    static inline std::unique_ptr<GameFolder> folder_;
    static inline std::unique_ptr<Session> session_;
    static inline std::string cube_path_;
};

// One hall's lamp goes out: there, and there alone, is what was known worthless. With the halls beside each other and,
// the head tilted, above each other.
TEST_F(History, GradientsActWhereTheLightChanged)
{
    constexpr int reach = 26; // pixels that the gradient's filter reaches over the floor
    session_->load_map("halls");
    session_->look({ -250, 0, 100 }, { 0, 0, 80 });
    for (const float roll : { 0.0f, 90.0f })
        for (const char* quantity : { "gradient", "alpha" }) {
            SCOPED_TRACE(std::string(quantity) + ", roll " + std::to_string(roll));
            session_->view.view_angles[2] = roll;
            session_->view.time += 100; // anew
            session_->set("flt_denoiser", "asvgf");
            session_->set("pt_debug_view", quantity);
            session_->draw(12);
            session_->light_style(left_style, 0);
            session_->draw();
            const formats::Image seen = session_->capture_display();
            session_->light_style(left_style, 1);
            int count[2] {}, changed[2] {};
            for (int y = 0; y < seen.height; y++)
                for (int x = 0; x < seen.width; x++) {
                    // The head's left side is up: what was on the left is below.
                    const int across = roll == 0 ? x - seen.width / 2 : seen.height / 2 - 1 - y;
                    if (std::abs(across) < reach)
                        continue;
                    const size_t hall = across < 0 ? 0 : 1;
                    count[hall]++;
                    changed[hall] += seen.at(x, y).r > 200;
                }
            EXPECT_GT(count[0], 3000);
            EXPECT_GT(changed[0], count[0] * 9 / 10);
            EXPECT_EQ(changed[1], 0) << "of " << count[1];
        }
}

// What a thing uncovers has no history, though the thing was as far away: it looked elsewhere.
TEST_F(History, SurfacesThatLookElsewhereAreOthers)
{
    session_->load_map("wall");
    session_->look({ 0, 0, 0 }, { wall_distance, 0, 0 }, 4);
    void* cube = session_->module().register_model(cube_path_.c_str());
    ASSERT_TRUE(cube);
    session_->set("flt_denoiser", "temporal");
    session_->set("pt_debug_view", "alpha");
    const auto draw_at = [&](float y, int frames) {
        engine::Entity entity = make_entity(cube, { wall_distance - 2, y, 0 });
        entity.angles[1] = 45; // an edge towards the camera
        session_->view.entities = &entity;
        session_->view.entity_count = 1;
        session_->draw(frames);
        session_->view.entities = nullptr;
        session_->view.entity_count = 0;
    };
    constexpr float before = -7, now = 7;
    draw_at(before, 12);
    draw_at(now, 1);
    const formats::Image seen = session_->capture_display();
    int uncovered = 0, kept = 0, known = 0, forgotten = 0;
    for (int y = 0; y < seen.height; y++)
        for (int x = 0; x < seen.width; x++) {
            const CameraRay ray = camera_ray(session_->view, { x + 0.5f, y + 0.5f });
            const glm::vec3 met = ray.direction * (wall_distance / ray.direction.x);
            const float off = std::abs(met.y - before) / (prism_half * std::sqrt(2.0f));
            // Near its edge the thing's normals, which are smooth, look at the camera.
            if (std::abs(met.z) < 0.85f * prism_half && off > 0.5f && off < 0.85f) {
                uncovered++;
                kept += seen.at(x, y).r < 250;
            } else if (off > 1.5f && std::abs(met.y - now) > 5) {
                known++;
                forgotten += seen.at(x, y).r > 128;
            }
        }
    EXPECT_GT(uncovered, 80);
    EXPECT_EQ(kept, 0) << "of " << uncovered;
    EXPECT_GT(known, 5000);
    EXPECT_EQ(forgotten, 0) << "of " << known;
}

// The picture becomes brighter at once: what anti-aliasing remembers is held to what the neighbourhood shows.
TEST_F(History, AntialiasingHoldsTheHistoryToTheNeighbourhood)
{
    session_->load_map("wall");
    session_->look({ 380, 60, 0 }, { wall_distance, 60, 0 });
    for (const char* mode : { "on", "upscale" }) {
        session_->set("flt_taa", mode);
        session_->view.time += 100;
        session_->light_style(0, 0.25f);
        session_->draw(16);
        const float dark = luminance(session_->capture().mean());
        session_->light_style(0, 1);
        session_->draw();
        const float at_once = luminance(session_->capture().mean());
        session_->draw(32);
        const float bright = luminance(session_->capture().mean());
        EXPECT_NEAR(bright, 4 * dark, 0.1f * bright) << mode;
        EXPECT_GT(at_once, 0.9f * bright) << mode;
    }
}

} // namespace
} // namespace vkpt::tests
