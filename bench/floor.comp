#version 460
// SPDX-License-Identifier: GPL-2.0-or-later
// The least that a pass over the screen's pixels costs: nothing at all, or one element of a screen buffer read and written.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

const uint group_size = 64u, runs = 8u; // as the module's passes: PIXEL_GROUP_SIZE, PIXEL_TILES_PER_GROUP
layout(local_size_x = group_size) in;
layout(constant_id = 0) const uint mode = 0u;
layout(push_constant, scalar) uniform PushConstants { uint64_t source, target; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Floats { vec4 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Words { uint64_t v[]; };

void main()
{
    if (mode == 0u)
        return;
    [[dont_unroll]] for (uint run = 0u; run < runs; run++) {
        uint pixel = (gl_WorkGroupID.x * runs + run) * group_size + gl_LocalInvocationIndex;
        if (mode == 1u) {
            Floats(target).v[pixel] = Floats(source).v[pixel];
        } else if (mode == 2u) {
            Words(target).v[pixel * 2u] = Words(source).v[pixel * 2u];
            Words(target).v[pixel * 2u + 1u] = Words(source).v[pixel * 2u + 1u];
        } else {
            Words(target).v[pixel] = Words(source).v[pixel];
        }
    }
}
