// SPDX-License-Identifier: GPL-2.0-or-later
// Unit vectors in 32 bits (octahedral map, 2 x 16 bit snorm; Cigolle et al., JCGT 2014) and colours in half floats.
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

uvec2 pack_half3(vec3 colour) { return uvec2(packHalf2x16(colour.xy), packHalf2x16(vec2(colour.z, 0.0))); }

vec3 unpack_half3(uvec2 bits) { return vec3(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y).x); }

#endif
