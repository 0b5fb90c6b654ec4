#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The 2D layer: six vertices a rectangle, fetched from the list by index.
#include "shared/quad.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Quads { Quad v[]; };
layout(push_constant, scalar) uniform Push { QuadPush push; };

layout(location = 0) out vec2 uv;
layout(location = 1) flat out vec4 color;
layout(location = 2) flat out uvec2 texture_and_sampler;

const vec2 corners[6] = { vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(0, 1), vec2(1, 0), vec2(1, 1) };

void main()
{
    const Quad quad = Quads(push.quads).v[gl_VertexIndex / 6];
    const vec2 corner = corners[gl_VertexIndex % 6];
    uv = mix(quad.uv_min, quad.uv_max, corner);
    color = unpackUnorm4x8(quad.color);
    texture_and_sampler = uvec2(quad.texture_slot, quad.sampler_index);
    gl_Position = vec4(mix(quad.corner_min, quad.corner_max, corner) * push.clip_per_pixel - 1, 0, 1);
}
