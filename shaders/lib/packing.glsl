// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers in a few bits each, unit vectors in 32. CPU drivers' own
// functions for it convert lane by lane (whole_numbers.glsl): here numbers are added to one so great that they end up,
// rounded, in its last bits.
#ifndef VKPT_LIB_PACKING
#define VKPT_LIB_PACKING

#include "../shared/functions.h"
#include "../shared/octahedral.h"
#include "device/quick_floats.glsl"
#include "device/whole_numbers.glsl"

// The last 16 bits of two words, the last 8 of four.
uint join_halves(uvec2 v) { return (v.x & 0xffffu) | (v.y << 16u); }
uint join_bytes(uvec4 v) { return (v.x & 0xffu) | ((v.y & 0xffu) << 8u) | ((v.z & 0xffu) << 16u) | (v.w << 24u); }
uvec2 split_halves(uint bits) { return uvec2(bits & 0xffffu, bits >> 16u); }

// From -1 to 1, in 16 bits each.
uint pack_snorm2(vec2 v) { return join_halves(floatBitsToUint(v * 32767.0f + whole_base)); }
vec2 unpack_snorm2(uint bits) { return vec2(ivec2(int(bits << 16u), int(bits)) >> 16) * (1.0f / 32767.0f); }

// From -1 to 1, in 8 bits each. Unpacked times 127.
uint pack_snorm4(vec4 v) { return join_bytes(floatBitsToUint(v * 127.0f + whole_base)); }
vec4 unpack_snorm4_times_127(uint bits) { return vec4(ivec4(uvec4(bits) << uvec4(24u, 16u, 8u, 0u)) >> 24); }

// Clamped to 0 to 1, in 8 bits each.
uint pack_unorm4(vec4 v)
{
    vec4 clamped = vec4(quick_clamp(vec3(v), 0.0f, 1.0f), quick_clamp(v.w, 0.0f, 1.0f));
    return join_bytes(floatBitsToUint(clamped * 255.0f + unsigned_whole_base));
}
vec4 unpack_unorm4(uint bits)
{
    return vec4(ivec4((uvec4(bits) >> uvec4(0u, 8u, 16u, 24u)) & 0xffu)) * (1.0f / 255.0f);
}

// From 0 to 1, in 16 bits each.
uint pack_unorm2(vec2 v) { return join_halves(floatBitsToUint(v * 65535.0f + unsigned_whole_base)); }
vec2 unpack_unorm2(uint bits) { return vec2(ivec2(split_halves(bits))) * (1.0f / 65535.0f); }

// Floats that lose their last 16 bits.
uint pack_upper_halves(vec2 v)
{
    uvec2 bits = floatBitsToUint(v) + 0x8000u;
    return (bits.x >> 16u) | (bits.y & 0xffff0000u);
}
vec2 unpack_upper_halves(uint bits) { return uintBitsToFloat(uvec2(bits << 16u, bits & 0xffff0000u)); }

// Three numbers from 0 to 32,000 with nine bits each and a common power of two, rounded up or down by chance (xi from 0
// to 1), so that a mean that changes little by little does change.
const int rgb9e5_bias = 25;
uint pack_rgb9e5(vec3 v, vec3 xi)
{
    int most = (floatBitsToInt(quick_max(v.x, quick_max(v.y, v.z))) >> 23) - 127; // power of two
    int power = clamp(most + rgb9e5_bias - 8, 0, 31);
    uvec3 parts = min(uvec3(v * intBitsToFloat((127 + rgb9e5_bias - power) << 23) + xi), uvec3(511u));
    return parts.x | (parts.y << 9u) | (parts.z << 18u) | (uint(power) << 27u);
}
vec3 unpack_rgb9e5(uint bits)
{
    float scale = intBitsToFloat((127 - rgb9e5_bias + int(bits >> 27u)) << 23);
    return vec3(ivec3(uvec3(bits, bits >> 9u, bits >> 18u) & 511u)) * scale;
}

uint pack_direction(vec3 direction) { return pack_snorm2(direction_to_octahedron(direction)); }
vec3 unpack_direction(uint bits) { return octahedron_to_direction(unpack_snorm2(bits)); }

// Three floats in 21 bits each: sign, 8 bits of exponent, 12 of mantissa, rounded. Infinite and NaN stay that, but for
// NaNs whose mantissa is nearly all ones: 0.
uint float21_bits(float x) { return (floatBitsToUint(x) + 0x400u) >> 11u; }
uvec2 pack_floats3(vec3 v)
{
    uint x = float21_bits(v.x), y = float21_bits(v.y), z = float21_bits(v.z);
    return uvec2(x | (y << 21u), (y >> 11u) | (z << 10u));
}
vec3 unpack_floats3(uvec2 bits)
{
    return uintBitsToFloat(
        uvec3(bits.x << 11u, ((bits.x >> 21u) << 11u) | (bits.y << 22u), (bits.y << 1u) & 0xfffff800u));
}

// A place on the screen, in pixels, and a depth: 22 bits for x and y each, in 256ths of a pixel, and 20 for the depth,
// a float without sign and the last 11 bits. Places beyond a screen of up to 16,375 pixels in width and height are
// moved to where they still are beyond it; depths below 0 become 0.
const float place_parts = 256.0f, first_place = -8.0f, last_place = 16375.0f;
uvec2 pack_place(vec2 place, float depth)
{
    vec2 parts = (clamp(place, first_place, last_place) - first_place) * place_parts;
    uvec2 at = floatBitsToUint(parts + unsigned_whole_base) & 0x3fffffu;
    uint depth_bits = (floatBitsToUint(quick_max(depth, 0.0f)) + 0x400u) >> 11u;
    return uvec2(at.x | (at.y << 22u), (at.y >> 10u) | (depth_bits << 12u));
}
// x, y, depth
vec3 unpack_place(uvec2 bits)
{
    ivec2 at = ivec2(int(bits.x & 0x3fffffu), int((bits.x >> 22u) | ((bits.y & 0xfffu) << 10u)));
    vec2 place = vec2(at) * (1.0f / place_parts) + first_place;
    return vec3(place.x, place.y, uintBitsToFloat((bits.y >> 12u) << 11u));
}

// A half float that is not negative, from its 16 bits. Denormal ones are 0 where the device flushes floats.
float unpack_positive_half(uint bits) { return uintBitsToFloat(bits << 13u) * 5.192296858534828e33f; }

// Light, and what else is never negative, in 16 bits: 6 of exponent and 10 of mantissa, from 7e-15, which stands for 0,
// to 131,000; what is greater, infinite or NaN becomes the greatest. Half floats would reach only to 6e-5 and 65,504,
// and cost CPU drivers more: they pack them by some 40 instructions each, unpack them out of 64-bit loads lane by lane,
// and compare what was unpacked as half floats, lane by lane, too.
const int min_light16 = 0x28000000; // 2^-47
uint light16_bits(float x) { return uint(clamp(floatBitsToInt(x) - (min_light16 - 0x1000), 0, 0x1fffffff)) >> 13u; }
uint pack_light2(vec2 v) { return light16_bits(v.x) | (light16_bits(v.y) << 16u); }
vec2 unpack_light2(uint bits)
{
    return vec2(uintBitsToFloat(((bits << 13u) & 0x1fffe000u) + uint(min_light16)),
        uintBitsToFloat(((bits >> 3u) & 0x1fffe000u) + uint(min_light16)));
}

uvec2 pack_light3(vec3 colour) { return uvec2(pack_light2(vec2(colour)), light16_bits(colour.z)); }
vec3 unpack_light3(uvec2 bits) { return vec3(unpack_light2(bits.x), unpack_light2(bits.y).x); }

#endif
