// SPDX-License-Identifier: GPL-2.0-or-later
// A kept view holds what the engine's pointed to, after the engine has changed it.
#include "ref_vkpt/photo/kept_refdef.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

TEST(KeptRefDef, HoldsWhatTheEnginesPointedTo)
{
    std::vector<engine::Entity> entities(3);
    entities[0].frame = 7;
    entities[1].flags = engine::RF_WEAPONMODEL | engine::RF_MINLIGHT;
    entities[2].flags = engine::RF_VIEWERMODEL | engine::RF_GLOW;
    std::vector<engine::DynamicLight> lights(1);
    lights[0].intensity = 200;
    std::vector<engine::Particle> particles(2);
    particles[1].color = 5;
    std::vector<engine::Lightstyle> styles(engine::max_lightstyles);
    styles[3].white = 2;
    engine::RefDef refdef {};
    refdef.time = 4;
    refdef.entities = entities.data();
    refdef.entity_count = 3;
    refdef.dlights = lights.data();
    refdef.dlight_count = 1;
    refdef.particles = particles.data();
    refdef.particle_count = 2;
    refdef.lightstyles = styles.data();
    const KeptRefDef kept(refdef);
    entities.assign(3, {});
    lights[0].intensity = 0;
    particles[1].color = 0;
    styles[3].white = 0;
    const engine::RefDef& copy = kept.refdef();
    EXPECT_EQ(copy.time, 4);
    ASSERT_EQ(copy.entity_count, 3);
    EXPECT_EQ(copy.entities[0].frame, 7);
    EXPECT_EQ(copy.entities[1].flags, engine::RF_WEAPONMODEL | engine::RF_MINLIGHT);
    EXPECT_EQ(copy.dlights[0].intensity, 200);
    EXPECT_EQ(copy.particles[1].color, 5);
    EXPECT_EQ(copy.lightstyles[3].white, 2);
    ASSERT_EQ(kept.seen_from_outside().size(), 2u);
    EXPECT_EQ(kept.seen_from_outside()[1].flags, engine::RF_GLOW);
}

TEST(KeptRefDef, TakesCountsThatAreNone)
{
    engine::RefDef refdef {};
    refdef.entity_count = -4;
    refdef.particle_count = 9;
    const KeptRefDef kept(refdef);
    EXPECT_EQ(kept.refdef().entity_count, 0);
    EXPECT_EQ(kept.refdef().particle_count, 0);
    EXPECT_EQ(kept.refdef().lightstyles, nullptr);
}

} // namespace
} // namespace vkpt::tests
