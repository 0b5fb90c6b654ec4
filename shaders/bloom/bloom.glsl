// SPDX-License-Identifier: GPL-2.0-or-later
// What the bloom's passes share: a pyramid of ever smaller images (after Jimenez, "Next Generation Post Processing in
// Call of Duty: Advanced Warfare", SIGGRAPH 2014 course). Every level is a weighted average, so that bloom takes no
// light away.
#ifndef VKPT_LIB_BLOOM
#define VKPT_LIB_BLOOM

#include "../lib/frame.glsl"
#include "../lib/packing.glsl"

vec3 load_bloom_level(uint64_t level, uvec2 size, ivec2 pixel)
{
    uvec2 at = uvec2(clamp(pixel, ivec2(0), ivec2(size) - 1));
    return unpack_light3(load_element(level, at.y * size.x + at.x, uvec2(0u)));
}

// Bilinear; `place`: (0, 0) to (1, 1) over the level.
vec3 sample_bloom_level(uint64_t level, uvec2 size, vec2 place)
{
    vec2 at = place * vec2(size) - 0.5, corner = floor(at), part = at - corner;
    ivec2 first = whole_to_int(corner);
    return mix(mix(load_bloom_level(level, size, first), load_bloom_level(level, size, first + ivec2(1, 0)), part.x),
        mix(load_bloom_level(level, size, first + ivec2(0, 1)), load_bloom_level(level, size, first + ivec2(1)),
            part.x),
        part.y);
}

#endif
