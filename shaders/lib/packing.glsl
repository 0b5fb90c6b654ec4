// SPDX-License-Identifier: GPL-2.0-or-later
// Unit vectors in 32 bits (octahedral map, 2 x 16 bit snorm; Cigolle et al., JCGT 2014) and light in 16 bits a number.
#ifndef VKPT_LIB_PACKING
#define VKPT_LIB_PACKING

uint pack_direction(vec3 direction)
{
    vec2 p = direction.xy / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    if (direction.z < 0.0)
        p = (1.0 - abs(p.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    return packSnorm2x16(p);
}

vec3 unpack_direction(uint bits)
{
    vec2 p = unpackSnorm2x16(bits);
    vec3 direction = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    if (direction.z < 0.0)
        direction.xy = (1.0 - abs(direction.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(direction.xy, vec2(0.0)));
    return normalize(direction);
}

// Light, and what else is never negative, in 16 bits: 6 of exponent and 10 of mantissa, from 7e-15, which stands for 0, to 131,000;
// what is greater, infinite or NaN becomes the greatest. Half floats would reach only to 6e-5 and 65,504, and cost CPU drivers more:
// they pack them by some 40 instructions each, unpack them out of 64-bit loads lane by lane, and compare what was unpacked as
// half floats, lane by lane, too.
const int least_light16 = 0x28000000; // 2^-47
uint light16_bits(float x)
{
    return uint(clamp(floatBitsToInt(x) - (least_light16 - 0x1000), 0, 0x1fffffff)) >> 13u;
}
uint pack_light2(vec2 v) { return light16_bits(v.x) | light16_bits(v.y) << 16u; }
vec2 unpack_light2(uint bits)
{
    return vec2(uintBitsToFloat(((bits << 13u) & 0x1fffe000u) + uint(least_light16)),
        uintBitsToFloat(((bits >> 3u) & 0x1fffe000u) + uint(least_light16)));
}

uvec2 pack_light3(vec3 colour) { return uvec2(pack_light2(colour.xy), light16_bits(colour.z)); }
vec3 unpack_light3(uvec2 bits) { return vec3(unpack_light2(bits.x), unpack_light2(bits.y).x); }

#endif
