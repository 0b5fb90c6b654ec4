#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The finished picture as words in the window's byte order, from where it is copied into the window. (A scaling or converting
// blit would be drawn, which Mesa's CPU driver cannot do at the vector width that our other passes want.)
#include "lib/frame.glsl"

layout(set = 0, binding = 1, rgba8) uniform readonly image2D picture;
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer WordBuffer { uint v[]; };
layout(push_constant, scalar) uniform Push
{
    uint64_t words;
    uvec2 size;       // of the window; the picture is cut or repeated at its edge where they differ for a frame
    uint swap_red_blue;
};

layout(local_size_x = PIXEL_GROUP_SIZE) in;

void main()
{
    ivec2 last = imageSize(picture) - 1;
    for (uint i = 0u; i < PIXEL_TILES_PER_GROUP; i++) {
        uint index = (gl_WorkGroupID.x * PIXEL_TILES_PER_GROUP + i) * PIXEL_GROUP_SIZE + gl_LocalInvocationIndex;
        if (index >= size.x * size.y)
            return;
        vec4 colour = imageLoad(picture, min(ivec2(index % size.x, index / size.x), last));
        WordBuffer(words).v[index] = packUnorm4x8(swap_red_blue != 0u ? colour.bgra : colour);
    }
}
