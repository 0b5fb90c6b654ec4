#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The 2D layer: picture times colour, straight alpha.
#include "shared/frame.h"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in vec4 color;
layout(location = 2) flat in uvec2 texture_and_sampler;

layout(set = 0, binding = 2) uniform sampler samplers[SAMPLER_COUNT];
layout(set = 0, binding = 3) uniform texture2D textures[];

layout(location = 0) out vec4 blended;

// The samplers are named one by one: Mesa's CPU driver cannot compile a varying index into them.
vec4 sample_picture(uint slot, uint sampler_index)
{
    switch (sampler_index) {
    case SAMPLER_REPEAT:
        return texture(sampler2D(textures[nonuniformEXT(slot)], samplers[SAMPLER_REPEAT]), uv);
    case SAMPLER_CLAMP:
        return texture(sampler2D(textures[nonuniformEXT(slot)], samplers[SAMPLER_CLAMP]), uv);
    case SAMPLER_REPEAT_NEAREST:
        return texture(sampler2D(textures[nonuniformEXT(slot)], samplers[SAMPLER_REPEAT_NEAREST]), uv);
    default:
        return texture(sampler2D(textures[nonuniformEXT(slot)], samplers[SAMPLER_CLAMP_NEAREST]), uv);
    }
}

void main() { blended = color * sample_picture(texture_and_sampler.x, texture_and_sampler.y); }
