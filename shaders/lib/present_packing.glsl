// SPDX-License-Identifier: GPL-2.0-or-later
// A pixel of the finished image as the words that a window's format has for it.
#ifndef VKPT_LIB_PRESENT_PACKING
#define VKPT_LIB_PRESENT_PACKING

#include "../shared/present.h"
#include "hdr.glsl"

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

vec3 unpack_highlight(uvec2 words) { return vec3(unpackHalf2x16(words.x), unpackHalf2x16(words.y).x); }
uvec2 pack_highlight(vec3 v) { return uvec2(packHalf2x16(vec2(v.x, v.y)), packHalf2x16(vec2(v.z, 0.0f))); }

// `word`: as above, with what 2D covers in its highest byte.
uvec2 pack_for_hdr_window(uint word, uvec2 highlight, uint packing, uint transfer, float paper_white, float peak)
{
    vec3 image = vec3(uvec3(word, word >> 8u, word >> 16u) & 0xffu) / 255.0f;
    float uncovered = 1.0f - float(word >> 24u) / 255.0f;
    if (uncovered > 0.0f)
        image += unpack_highlight(highlight) * uncovered;
    vec3 light = shown_luminance(image, paper_white, peak);
    if (transfer == PRESENT_SCRGB) {
        vec3 scaled = light / SCRGB_WHITE;
        return uvec2(packHalf2x16(vec2(scaled.x, scaled.y)), packHalf2x16(vec2(scaled.z, 1.0f)));
    }
    uvec3 rgb = uvec3(encode_pq(widen_primaries(light)) * 1023.0f + 0.5f);
    return uvec2(join_10_bits(packing == PRESENT_BGR10A2 ? uvec3(rgb.z, rgb.y, rgb.x) : rgb), 0u);
}

#endif
