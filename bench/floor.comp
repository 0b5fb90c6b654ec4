#version 460
// SPDX-License-Identifier: GPL-2.0-or-later
// The least that a pass over the screen's pixels costs: nothing at all, or one element of a screen buffer or image read
// and written; and what it costs to read a table at random places.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

const uint group_size = 64u, runs = 8u; // as the module's passes: PIXEL_GROUP_SIZE, PIXEL_TILES_PER_GROUP
const uint width = 640u, reads = 16u;
layout(local_size_x = group_size) in;
layout(constant_id = 0) const uint mode = 0u;
layout(push_constant, scalar) uniform PushConstants
{
    uint64_t source, target;
    uint table_mask;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Floats { vec4 v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Numbers { uint v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Words { uint64_t v[]; };
layout(binding = 0, rgba32f) uniform readonly image2D source_floats;
layout(binding = 1, rgba32f) uniform writeonly image2D target_floats;
layout(binding = 2, rgba16f) uniform readonly image2D source_halves;
layout(binding = 3, rgba16f) uniform writeonly image2D target_halves;
layout(binding = 4) uniform utextureBuffer table;

// Tiles of 8 x 8 pixels, as the module walks them.
ivec2 place_of(uint pixel)
{
    uint tile = pixel / 64u, tiles_across = width / 8u;
    return ivec2(tile % tiles_across * 8u + pixel % 8u, tile / tiles_across * 8u + pixel / 8u % 8u);
}

uvec4 read_table(uint place)
{
    if (mode == 7u)
        return uvec4(Numbers(source).v[place * 4u], Numbers(source).v[place * 4u + 1u],
            Numbers(source).v[place * 4u + 2u], Numbers(source).v[place * 4u + 3u]);
    if (mode == 8u)
        return uvec4(unpack32(Words(source).v[place * 2u]), unpack32(Words(source).v[place * 2u + 1u]));
    if (mode == 9u)
        return texelFetch(table, int(place));
    return uvec4(place);
}

void read_at_random(uint pixel)
{
    uint state = pixel * 2654435761u;
    uvec4 sum = uvec4(0u);
    [[dont_unroll]] for (uint i = 0u; i < reads; i++)
    {
        state = state * 1664525u + 1013904223u;
        sum ^= read_table((state >> 12u) & table_mask);
    }
    Numbers(target).v[pixel] = sum.x ^ sum.y ^ sum.z ^ sum.w;
}

void main()
{
    if (mode == 0u)
        return;
    [[dont_unroll]] for (uint run = 0u; run < runs; run++)
    {
        uint pixel = (gl_WorkGroupID.x * runs + run) * group_size + gl_LocalInvocationIndex;
        if (mode == 1u) {
            Floats(target).v[pixel] = Floats(source).v[pixel];
        } else if (mode == 2u) {
            Words(target).v[pixel * 2u] = Words(source).v[pixel * 2u];
            Words(target).v[pixel * 2u + 1u] = Words(source).v[pixel * 2u + 1u];
        } else if (mode == 3u) {
            imageStore(target_floats, place_of(pixel), imageLoad(source_floats, place_of(pixel)));
        } else if (mode == 4u) {
            Words(target).v[pixel] = Words(source).v[pixel];
        } else if (mode == 5u) {
            imageStore(target_halves, place_of(pixel), imageLoad(source_halves, place_of(pixel)));
        } else {
            read_at_random(pixel);
        }
    }
}
