#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The finished picture in the window's byte order, from where it is copied into the window. (A scaling or converting blit would be
// drawn, which Mesa's CPU driver cannot do at the vector width that our other passes want.)
#include "lib/frame.glsl"

layout(push_constant, scalar) uniform Push
{
    uint64_t picture; // FrameUniforms::output_words
    uint64_t words;
    uvec2 picture_size;
    uvec2 size; // of the window; the picture is cut or repeated at its edge where they differ for a frame
    uint swap_red_blue;
};

void show_pixel(uvec2 pixel, uint index)
{
    uvec2 from = min(pixel, picture_size - 1u);
    uint word = load_element(picture, from.y * picture_size.x + from.x, 0u);
    if (swap_red_blue != 0u)
        word = (word & 0xff00ff00u) | (word >> 16u & 0xffu) | (word & 0xffu) << 16u;
    store_element(words, index, word);
}

VKPT_RUN_OVER(size, show_pixel)
