#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The 2D layer: one workgroup blends the quads of one tile over the texture, straight alpha, in drawing order. A
// compute pass rather than triangles: each pixel is read and written once, and Mesa's CPU driver rasterises badly.
#include "lib/frame.glsl"
#include "lib/packing.glsl"
#include "shared/quad.h"

VKPT_PUSH_CONSTANTS
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer QuadList { Quad v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer QuadTileList { QuadTile v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer QuadIndexList { uint v[]; };

layout(local_size_x = 8, local_size_y = 8) in;

vec4 sample_texture(uint slot, uint sampler_index, vec2 uv)
{
    return textureLod(sampler2D(textures[slot], samplers[sampler_index]), uv, 0.0);
}

// What a lane holds of a tile: one pixel of each 8 x 8 quarter. A quad is read once for all of them.
const uint quarters = 4u;

uvec2 pixel_of_quarter(uvec2 first, uint quarter) { return first + uvec2(quarter & 1u, quarter >> 1u) * 8u; }

uint output_index(uvec2 pixel) { return pixel.y * push.output_size.x + pixel.x; }

vec4 blend(vec4 below, Quad quad, vec2 point)
{
    const bool inside = all(greaterThanEqual(point, quad.corner_min)) && all(lessThan(point, quad.corner_max));
    vec4 color = unpack_unorm4(quad.color);
    if ((quad.flags & QUAD_PLAIN) == 0u) {
        const vec2 place = (point - quad.corner_min) / (quad.corner_max - quad.corner_min);
        color *= sample_texture(quad.texture_slot, quad.sampler_index, mix(quad.uv_min, quad.uv_max, place));
    }
    if (push.intensity != 1.0 || push.exponent != 1.0)
        color.rgb = quick_min(pow(color.rgb * push.intensity, vec3(push.exponent)), vec3(1.0));
    const float alpha = inside ? color.a : 0.0;
    return vec4(mix(below.rgb, color.rgb, alpha), alpha + below.a * (1.0 - alpha));
}

void main()
{
    const QuadTile tile = QuadTileList(push.tiles).v[gl_WorkGroupID.x];
    const uvec2 first = tile.origin + gl_LocalInvocationID.xy;
    vec4 colors[quarters];
    UNROLLED_FOR (uint i = 0u; i < quarters; i++)
        colors[i] = vec4(0.0);
    if (tile.covered == 0u)
        UNROLLED_FOR (uint i = 0u; i < quarters; i++)
            colors[i] = unpack_unorm4(load_element(
                push.output_words, output_index(min(pixel_of_quarter(first, i), push.output_size - 1u)), 0u));
    for (uint place = 0u; place < tile.count; place++) {
        const Quad quad = QuadList(push.quads).v[QuadIndexList(push.quad_indices).v[tile.first + place]];
        UNROLLED_FOR (uint i = 0u; i < quarters; i++)
            colors[i] = blend(colors[i], quad, vec2(pixel_of_quarter(first, i)) + 0.5);
    }
    UNROLLED_FOR (uint i = 0u; i < quarters; i++) {
        const uvec2 pixel = pixel_of_quarter(first, i);
        if (all(lessThan(pixel, push.output_size)))
            store_element(push.output_words, output_index(pixel), pack_unorm4(colors[i]));
    }
}
