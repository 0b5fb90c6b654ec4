// SPDX-License-Identifier: GPL-2.0-or-later
// What lies between two recorded views.
#include "common/trace/blend_views.hpp"

#include <gtest/gtest.h>

namespace vkpt::trace {
namespace {

View make_view(float time, float x)
{
    View view;
    view.refdef.time = time;
    view.refdef.fov_x = 90;
    view.refdef.view_origin[0] = x;
    return view;
}

View::Entity make_entity(uint32_t model, float x)
{
    View::Entity entity {};
    entity.model = model;
    entity.entity.origin[0] = entity.entity.previous_origin[0] = x;
    return entity;
}

// Where a model is shown.
float place(const engine::Entity& entity)
{
    return entity.origin[0] * (1 - entity.backlerp) + entity.previous_origin[0] * entity.backlerp;
}

TEST(BlendViews, CameraGoesStraightAndTurnsTheShortWay)
{
    View before = make_view(1, 0), after = make_view(1.5f, 20);
    before.refdef.view_angles[1] = 170;
    after.refdef.view_angles[1] = -170;
    after.refdef.fov_x = 80;
    const View view = blend_views(before, after, 0.25f);
    EXPECT_FLOAT_EQ(view.refdef.view_origin[0], 5);
    EXPECT_FLOAT_EQ(view.refdef.view_angles[1], 175);
    EXPECT_FLOAT_EQ(view.refdef.time, 1.125f);
    EXPECT_FLOAT_EQ(view.refdef.fov_x, 87.5f);
}

TEST(BlendViews, ACutHasNothingInBetween)
{
    const View here = make_view(1, 0), far = make_view(1.1f, 500), earlier = make_view(0.5f, 4), late = make_view(9, 4);
    for (const View& other : { far, earlier, late }) {
        EXPECT_EQ(blend_views(here, other, 0.4f).refdef.view_origin[0], 0);
        EXPECT_EQ(blend_views(here, other, 0.6f).refdef.view_origin[0], other.refdef.view_origin[0]);
    }
}

// Each goes to the nearest one of its kind; what comes and goes is there for half of the time.
TEST(BlendViews, ThingsAreMatched)
{
    View before = make_view(1, 0), after = make_view(1.1f, 0);
    before.entities = { make_entity(1, 0), make_entity(1, 50), make_entity(2, 7) };
    after.entities = { make_entity(1, 60), make_entity(1, 10), make_entity(3, 9) };
    const View early = blend_views(before, after, 0.3f);
    ASSERT_EQ(early.entities.size(), 3u);
    EXPECT_FLOAT_EQ(early.entities[0].entity.origin[0], 3);
    EXPECT_FLOAT_EQ(early.entities[1].entity.origin[0], 53);
    EXPECT_EQ(early.entities[2].model, 2u);
    const View late = blend_views(before, after, 0.7f);
    ASSERT_EQ(late.entities.size(), 3u);
    EXPECT_FLOAT_EQ(late.entities[0].entity.origin[0], 7);
    EXPECT_EQ(late.entities[2].model, 3u);
    EXPECT_FLOAT_EQ(late.entities[2].entity.origin[0], 9) << "it was nowhere before";
}

// From 0.3 of the way to frame 5 to 0.4 of the way to frame 6: 1.1 frames in all.
TEST(BlendViews, AnimationsGoOnOverTheEndOfAFrame)
{
    View before = make_view(1, 0), after = make_view(1.1f, 0);
    before.entities = { make_entity(1, 0) };
    after.entities = { make_entity(1, 0) };
    engine::Entity &first = before.entities[0].entity, &second = after.entities[0].entity;
    first.previous_frame = 4;
    first.frame = second.previous_frame = 5;
    second.frame = 6;
    first.backlerp = 0.7f;
    second.backlerp = 0.6f;
    const engine::Entity early = blend_views(before, after, 0.5f).entities[0].entity;
    EXPECT_EQ(early.frame, 5);
    EXPECT_NEAR(early.backlerp, 0.15f, 1e-5f);
    const engine::Entity late = blend_views(before, after, 0.8f).entities[0].entity;
    EXPECT_EQ(late.frame, 6);
    EXPECT_EQ(late.previous_frame, 5);
    EXPECT_NEAR(late.backlerp, 1 - 0.18f, 1e-5f);
}

// The engine may give two places and how far it is from one to the other.
TEST(BlendViews, PlacesBetweenPlacesAreWhereTheyAreShown)
{
    View before = make_view(1, 0), after = make_view(1.1f, 0);
    before.entities = { make_entity(1, 10) };
    after.entities = { make_entity(1, 20) };
    engine::Entity &first = before.entities[0].entity, &second = after.entities[0].entity;
    first.previous_origin[0] = 0;
    first.backlerp = 0.2f; // shown at 8
    second.previous_origin[0] = 10;
    second.backlerp = 0.6f; // shown at 14
    for (const float share : { 0.0f, 0.25f, 0.5f, 1.0f })
        EXPECT_NEAR(place(blend_views(before, after, share).entities[0].entity), 8 + 6 * share, 1e-4f) << share;
}

TEST(BlendViews, ParticlesAndLightsMove)
{
    View before = make_view(1, 0), after = make_view(1.1f, 0);
    before.particles = { { { 1, 0, 0 }, 7, 1 }, { { 5, 0, 0 }, 7, 0.5f } };
    after.particles
        = { { { 100, 0, 0 }, 7, 1 }, { { 2, 0, 0 }, 7, 1 }, { { 6, 0, 0 }, 7, 0.3f } }; // a new one in front
    before.dlights = { { { 0, 0, 0 }, { 1, 1, 1 }, 200 } };
    after.dlights = { { { 10, 0, 0 }, { 1, 1, 1 }, 100 } };
    const View view = blend_views(before, after, 0.25f);
    ASSERT_EQ(view.particles.size(), 2u);
    EXPECT_FLOAT_EQ(view.particles[0].origin[0], 1.25f);
    EXPECT_FLOAT_EQ(view.particles[1].alpha, 0.45f);
    ASSERT_EQ(view.dlights.size(), 1u);
    EXPECT_FLOAT_EQ(view.dlights[0].origin[0], 2.5f);
    EXPECT_FLOAT_EQ(view.dlights[0].intensity, 175);
}

} // namespace
} // namespace vkpt::trace
