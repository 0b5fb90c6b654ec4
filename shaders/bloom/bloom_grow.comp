#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Mixes a level of the bloom's pyramid with the coarser ones below it, from the smallest upwards.
#include "../lib/frame.glsl"
#include "bloom.glsl"

VKPT_PUSH_CONSTANTS

void grow_pixel(uvec2 pixel, uint index)
{
    vec3 own = unpack_light3(load_element(push.target, index, uvec2(0u)));
    vec3 coarser = sample_bloom_level(push.source, push.source_size, (vec2(pixel) + 0.5) / vec2(push.target_size));
    store_element(push.target, index, pack_light3(mix(coarser, own, push.own_share)));
}

VKPT_RUN_OVER(push.target_size, grow_pixel)
