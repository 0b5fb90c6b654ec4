#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// A level of the bloom's pyramid from the one before, of twice its size; the first one from the image, of four times
// its size.
#include "../lib/frame.glsl"
#include "../lib/exposure.glsl"
#include "bloom.glsl"
#include "../lib/bsdf.glsl"

VKPT_PUSH_CONSTANTS
// Very bright pixels count less, or a single one would flicker over the whole image.
vec3 shrink_image(uvec2 pixel)
{
    float scale = ExposureBuffer(frame.exposure).v.exposure, weights = 0.0;
    vec3 sum = vec3(0.0);
    ROLLED_FOR (uint i = 0u; i < BLOOM_FIRST_STEP * BLOOM_FIRST_STEP; i++) {
        uvec2 at
            = min(pixel * BLOOM_FIRST_STEP + uvec2(i % BLOOM_FIRST_STEP, i / BLOOM_FIRST_STEP), push.source_size - 1u);
        vec3 radiance = load_accumulated(at.y * push.source_size.x + at.x).rgb;
        float weight = 1.0 / (1.0 + 0.1 * scale * luminance(radiance));
        sum += radiance * weight;
        weights += weight;
    }
    return min(sum / weights, 60000.0); // 16 bits end soon after
}

// 4 x 4 pixels by the weights 1 3 3 1.
vec3 shrink_level(uvec2 pixel)
{
    vec3 sum = vec3(0.0);
    ROLLED_FOR (uint i = 0u; i < 16u; i++) {
        ivec2 way = ivec2(i % 4u, i / 4u);
        vec2 weight = mix(vec2(1.0), vec2(3.0), equal(ivec2(1), (way + 1) / 2));
        sum += load_bloom_level(push.source, push.source_size, ivec2(pixel) * 2 + way - 1)
            * (weight.x * weight.y / 64.0);
    }
    return sum;
}

void shrink_pixel(uvec2 pixel, uint index)
{
    store_element(push.target, index, pack_light3(push.source == 0ul ? shrink_image(pixel) : shrink_level(pixel)));
}

VKPT_RUN_OVER(push.target_size, shrink_pixel)
