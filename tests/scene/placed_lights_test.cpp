// SPDX-License-Identifier: GPL-2.0-or-later
// The game module's lights as emitters.
#include "ref_vkpt/scene/placed_lights.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace vkpt {

namespace {

using formats::LightModel;

constexpr float scale = 0.001f;

std::vector<shared::Emitter> place(
    LightModel model, const formats::CodedLight& light, const Transform& transform = {}, float time = 0)
{
    std::vector<shared::Emitter> emitters;
    append_placed_lights(model, light, transform, time, scale, emitters);
    return emitters;
}

} // namespace

TEST(PlacedLights, ABulbSendsTheIntensityOfItsValue)
{
    const formats::CodedLight light { { 1, 0.5f, 0 }, 100, 4 };
    const auto emitters = place(LightModel::bulb, light, { glm::vec3(1, 2, 3) });
    ASSERT_EQ(emitters.size(), 1u);
    EXPECT_EQ(emitters[0].type, shared::EMITTER_SPHERE);
    EXPECT_EQ(emitters[0].p0, glm::vec3(1, 2, 3));
    EXPECT_EQ(emitters[0].p1.x, 4);
    const float disc = std::numbers::pi_v<float> * 16;
    EXPECT_NEAR(emitters[0].radiance.x * disc, scale * 1e6f, 1);
    EXPECT_NEAR(emitters[0].radiance.y * disc, scale * 0.5e6f, 1);
    EXPECT_EQ(emitters[0].radiance.z, 0);
    EXPECT_NEAR(emitters[0].area, 4 * disc, 1e-3);
}

TEST(PlacedLights, AFlareBurnsAtItsTip)
{
    Transform turned = md2_transform({ 10, 0, 0 }, { 0, 90, 0 });
    const auto emitters = place(LightModel::flare, {}, turned);
    ASSERT_EQ(emitters.size(), 1u);
    EXPECT_LT(glm::distance(emitters[0].p0, glm::vec3(10, formats::flare_tip, 0)), 1e-4f);
}

TEST(PlacedLights, ASwarmMovesWithinItsBall)
{
    formats::CodedLight light;
    light.count = 16;
    const auto now = place(LightModel::swarm, light, {}, 1), later = place(LightModel::swarm, light, {}, 1.1f);
    ASSERT_EQ(now.size(), 16u);
    for (size_t i = 0; i < now.size(); i++) {
        EXPECT_LE(glm::length(now[i].p0), formats::swarm_radius * 1.001f);
        EXPECT_GT(glm::distance(now[i].p0, later[i].p0), 0.1f);
        for (size_t j = 0; j < i; j++)
            EXPECT_GT(glm::distance(now[i].p0, now[j].p0), 0.1f);
    }
    EXPECT_EQ(place(LightModel::bulb, light).size(), 1u);
}

TEST(PlacedLights, NumbersThatAreNotSaneShineNot)
{
    EXPECT_TRUE(place(LightModel::bulb, {}, { glm::vec3(std::numeric_limits<float>::quiet_NaN()) }).empty());
    EXPECT_TRUE(place(LightModel::bulb, { glm::vec3(0) }).empty());
}

} // namespace vkpt
