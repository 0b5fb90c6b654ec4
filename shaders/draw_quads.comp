#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The 2D layer: one workgroup blends the quads of one tile over the picture, straight alpha, in drawing order. A compute
// pass rather than triangles: each pixel is read and written once, and Mesa's CPU driver rasterises badly.
#include "lib/frame.glsl"
#include "shared/quad.h"

layout(set = 0, binding = 1, rgba8) uniform image2D picture;
layout(push_constant, scalar) uniform Push { QuadPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer QuadList { Quad v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer QuadTileList { QuadTile v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer QuadIndexList { uint v[]; };

layout(local_size_x = 8, local_size_y = 8) in;

vec4 sample_picture(uint slot, uint sampler_index, vec2 uv)
{
    // The samplers are named one by one, so that their index never varies within a call.
    switch (sampler_index) {
    case SAMPLER_REPEAT:
        return textureLod(sampler2D(textures[nonuniformEXT(slot)], samplers[SAMPLER_REPEAT]), uv, 0.0);
    case SAMPLER_CLAMP:
        return textureLod(sampler2D(textures[nonuniformEXT(slot)], samplers[SAMPLER_CLAMP]), uv, 0.0);
    case SAMPLER_REPEAT_NEAREST:
        return textureLod(sampler2D(textures[nonuniformEXT(slot)], samplers[SAMPLER_REPEAT_NEAREST]), uv, 0.0);
    default:
        return textureLod(sampler2D(textures[nonuniformEXT(slot)], samplers[SAMPLER_CLAMP_NEAREST]), uv, 0.0);
    }
}

vec4 blend_quads(vec4 below, QuadTile tile, vec2 point)
{
    for (uint i = 0u; i < tile.count; i++) {
        const Quad quad = QuadList(push.quads).v[QuadIndexList(push.quad_indices).v[tile.first + i]];
        if (any(lessThan(point, quad.corner_min)) || any(greaterThanEqual(point, quad.corner_max)))
            continue;
        const vec2 place = (point - quad.corner_min) / (quad.corner_max - quad.corner_min);
        const vec2 uv = mix(quad.uv_min, quad.uv_max, place);
        const vec4 color = unpackUnorm4x8(quad.color) * sample_picture(quad.texture_slot, quad.sampler_index, uv);
        below.rgb = mix(below.rgb, color.rgb, color.a);
        below.a = color.a + below.a * (1.0 - color.a);
    }
    return below;
}

void main()
{
    const QuadTile tile = QuadTileList(push.tiles).v[gl_WorkGroupID.x];
    for (uint y = gl_LocalInvocationID.y; y < QUAD_TILE_SIZE; y += 8u)
        for (uint x = gl_LocalInvocationID.x; x < QUAD_TILE_SIZE; x += 8u) {
            const uvec2 pixel = tile.origin + uvec2(x, y);
            if (any(greaterThanEqual(pixel, push.output_size)))
                continue;
            const vec4 below = imageLoad(picture, ivec2(pixel));
            imageStore(picture, ivec2(pixel), blend_quads(below, tile, vec2(pixel) + 0.5));
        }
}
