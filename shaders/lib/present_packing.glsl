// SPDX-License-Identifier: GPL-2.0-or-later
// A pixel of the finished image as the words that a window's format has for it.
#ifndef VKPT_LIB_PRESENT_PACKING
#define VKPT_LIB_PRESENT_PACKING

#include "../shared/present.h"

// 8 bits as 10: the nearest of as many shares of the whole.
uvec3 widen_to_10_bits(uvec3 v) { return (v * 1023u + 127u) / 255u; }

uint join_10_bits(uvec3 v) { return v.x | (v.y << 10u) | (v.z << 20u) | 0xc0000000u; }

// `word`: red in the lowest byte, then green, blue and what is not looked at. Formats of one word leave the second one
// 0.
uvec2 pack_for_window(uint word, uint packing)
{
    uvec3 rgb = uvec3(word, word >> 8u, word >> 16u) & 0xffu;
    if (packing == PRESENT_RGBA8)
        return uvec2(word, 0u);
    if (packing == PRESENT_BGRA8)
        return uvec2((word & 0xff00ff00u) | rgb.z | (rgb.x << 16u), 0u);
    if (packing == PRESENT_RGB10A2)
        return uvec2(join_10_bits(widen_to_10_bits(rgb)), 0u);
    if (packing == PRESENT_BGR10A2)
        return uvec2(join_10_bits(widen_to_10_bits(uvec3(rgb.z, rgb.y, rgb.x))), 0u);
    vec3 shares = vec3(rgb) / 255.0f;
    return uvec2(packHalf2x16(vec2(shares.x, shares.y)), packHalf2x16(vec2(shares.z, 1.0f)));
}

#endif
