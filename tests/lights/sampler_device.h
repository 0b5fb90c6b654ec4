// SPDX-License-Identifier: GPL-2.0-or-later
// What sampler.comp and the test that dispatches it share.
#ifndef VKPT_TESTS_SAMPLER_DEVICE_H
#define VKPT_TESTS_SAMPLER_DEVICE_H

#include "shaders/shared/frame.h"

VKPT_SHARED_BEGIN

// The random numbers of one estimate, and the emitter whose probability is asked for.
struct DeviceDraw {
    vec2 point;
    float light;
    uint stream;
    vec2 bsdf_direction;
    float bsdf_lobe;
    uint emitter;
};
VKPT_ASSERT_SIZE(DeviceDraw, 32);

struct DeviceResult {
    vec2 point;
    int picked; // emitter, -1: none
    float probability; // of it
    float by_light; // luminance that light sampling found
    float by_bsdf; // and the BSDF ray, where the sampler has MIS
    float told; // light_probability of the emitter asked for
    float padding;
};
VKPT_ASSERT_SIZE(DeviceResult, 32);

// A light list, a surface and the options; addresses of tables.
struct DeviceCase {
    uint64_t emitters;
    uint64_t packed_lights;
    uint64_t lists; // one
    uint64_t static_indices;
    uint64_t dynamic_indices;
    SamplerTableAddresses sampler_tables;
    uint64_t lightstyles;
    uint64_t ltc;
    uint64_t draws;
    uint64_t results;
    uint emitter_count;
    uint draw_count;
    uint subset_length;
    int weight;
    int point;
    float roughness;
    float metallic;
    vec3 position;
    vec3 normal;
    vec3 view;
    vec3 albedo;
    uint tree_lights;
};
VKPT_ASSERT_SIZE(DeviceCase, 152 + sizeof(SamplerTableAddresses));

VKPT_CONST uint SAMPLER_GROUP = 64u; // lanes, an estimate each

VKPT_SHARED_END

#endif
