// SPDX-License-Identifier: GPL-2.0-or-later
// The light that goes with the eye.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

class Flashlight : public testing::Test {
protected:
    Flashlight()
    {
        folder_.add_wall("wall", white_index);
        MapBuilder map;
        map.add_room({ -300, -300, -300 }, { 300, 300, 300 }, map.add_material("wall"));
        folder_.add_map("dark", map.finish());
        session_ = std::make_unique<Session>(folder_,
            CvarList { { "pt_bounces", "0" }, { "pt_roughness_default", "1" }, { "pt_light_sampler", "full" } });
        session_->load_map("dark");
    }
    // Irradiance / pi on the wall at x = 299.
    float light_at(float y, float z)
    {
        session_->draw(); // the scene that is asked is the last view's
        const std::vector<IrradianceProbe> probes(32, { { 299, y, z }, { -1, 0, 0 } });
        float sum = 0;
        for (const glm::vec3& light : session_->probe(probes, 64))
            sum += light.y / 32;
        return sum;
    }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
};

TEST_F(Flashlight, ShinesWhereThePlayerLooks)
{
    session_->look({ 0, 0, 0 }, { 100, 0, 0 });
    EXPECT_EQ(light_at(0, 0), 0);
    session_->set("pt_flashlight", 1);
    const float ahead = light_at(0, 0);
    EXPECT_GT(ahead, 0.05f);
    // It is 90 degrees wide: as wide at the wall as that is away, on either side.
    EXPECT_GT(light_at(180, 0), 0.2f * ahead);
    EXPECT_LT(light_at(299, 280), 1e-3f * ahead);
    session_->look({ 0, 0, 0 }, { -100, 0, 0 });
    EXPECT_EQ(light_at(0, 0), 0);
}

// It stands beside the eye, so that things throw shadows that are seen.
TEST_F(Flashlight, ThrowsShadowsToTheOtherSide)
{
    folder_.add_cube("cube", 8, 100);
    session_->set("pt_flashlight", 1);
    session_->look({ 0, 0, 0 }, { 100, 0, 0 });
    const engine::Entity cube = make_entity(session_->module().register_model("models/cube.md2"), { 60, 0, 0 });
    session_->view.entities = &cube;
    session_->view.entity_count = 1;
    // From 6 to the right (-y) and 6 below, past the cube's middle, to a wall five times as far.
    const float shadowed = light_at(24, 24), beside = light_at(-60, -60);
    EXPECT_GT(beside, 0.05f);
    EXPECT_LT(shadowed, 0.02f * beside);
}

TEST_F(Flashlight, IsSwitchedByACommand)
{
    const auto run = [&] { session_->host().run_text("flashlight\n"); };
    run();
    session_->draw();
    EXPECT_EQ(session_->host().cvars().find("pt_flashlight")->number, 1);
    run();
    session_->draw();
    EXPECT_EQ(session_->host().cvars().find("pt_flashlight")->number, 0);
}

} // namespace
} // namespace vkpt::tests
