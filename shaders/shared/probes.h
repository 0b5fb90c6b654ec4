// SPDX-License-Identifier: GPL-2.0-or-later
// What hosts ask of the scene beside images (ref_vkpt/extension.hpp): irradiance at points, rays, and what the light
// sampler makes of one pixel. Quake world units, linear RGB.
#ifndef VKPT_SHARED_PROBES_H
#define VKPT_SHARED_PROBES_H

#include "language.h"

VKPT_SHARED_BEGIN

// A surface point to be lit; unit normal.
struct IrradianceProbe {
    vec3 position;
    vec3 normal;
};
VKPT_ASSERT_SIZE(IrradianceProbe, 24);

// A ray through the scene; unit direction. It meets triangles between t_min and t_max.
struct TracedRay {
    vec3 origin;
    float t_min;
    vec3 direction;
    float t_max;
};
VKPT_ASSERT_SIZE(TracedRay, 32);

struct TracedHit {
    uint triangle; // id, or 0xffffffff: nothing was met. Where visibility is asked for, any other number: something
    float t;
    vec2 barycentrics; // weights of the triangle's second and third corner
    uint front; // 1: met from its front
};
VKPT_ASSERT_SIZE(TracedHit, 20);

// The surface that a pixel of the last view shows.
struct InspectedSurface {
    vec3 position;
    float depth; // path length from the eye; < 0: sky or an unlit image, the other fields but `emitted` mean nothing
    vec3 normal;
    float roughness;
    vec3 geometric_normal;
    float metallic;
    vec3 albedo;
    int cluster; // of the PVS, -1: outside of the map
    vec3 emitted; // radiance to the eye without the surface's reflection
    uint light_count; // of the cluster's list
    uint choices; // how often the light sampler was asked to count InspectedLight::picked
};
VKPT_ASSERT_SIZE(InspectedSurface, 84);

// A light of that surface's list, as the light sampler in use sees it.
struct InspectedLight {
    uint emitter; // index into the emitter table
    uint type; // EMITTER_* of scene.h
    vec3 centre;
    float area; // square units
    vec3 radiance; // average, with its lightstyle applied
    uint lightstyle;
    float weight; // the predicted contribution that importance samplers choose by, shadows unknown
    float probability; // light_probability, averaged over random numbers
    uint picked; // by how many of InspectedSurface::choices
};
VKPT_ASSERT_SIZE(InspectedLight, 52);

VKPT_SHARED_END

#endif
