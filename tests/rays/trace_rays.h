// SPDX-License-Identifier: GPL-2.0-or-later
// What trace_rays.comp and its callers (test, bench) share.
#ifndef VKPT_TESTS_TRACE_RAYS_H
#define VKPT_TESTS_TRACE_RAYS_H

#include "shaders/shared/language.h"
#include "shaders/shared/trace.h"

VKPT_SHARED_BEGIN

struct TestRay {
    vec3 origin;
    float t_min;
    vec3 direction;
    float t_max; // <= t_min: this ray is not traced
};
VKPT_ASSERT_SIZE(TestRay, 32);

struct TestHit {
    uint triangle;
    float t;
    vec2 barycentrics;
    uint front;
    uint padding; // to 8 bytes, for the driver's wide stores
};
VKPT_ASSERT_SIZE(TestHit, 24);

struct TraceRaysPush {
    uint64_t rays; // TestRay
    uint64_t hits; // TestHit
    uint64_t stack;
    uint ray_count;
    uint ray_mask;
    BvhView trees;
};
VKPT_ASSERT_SIZE(TraceRaysPush, 56); // Vulkan promises room for 128

VKPT_CONST uint TRACE_RAYS_GROUP = 64u; // lanes
VKPT_CONST uint TRACE_RAYS_PER_GROUP = 64u * 8u; // every lane traces 8 rays: fewer lanes, fewer stacks

VKPT_SHARED_END

#endif
