#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The finished picture in the window's byte order, from where it is copied into the window. (A scaling or converting blit would be
// drawn, which Mesa's CPU driver cannot do at the vector width that our other passes want.)
#include "lib/frame.glsl"
#include "shared/present.h"

VKPT_PUSH_CONSTANTS

void show_pixel(uvec2 pixel, uint index)
{
    uvec2 from = min(pixel, push.picture_size - 1u);
    uint word = load_element(push.picture, from.y * push.picture_size.x + from.x, 0u);
    if (push.swap_red_blue != 0u)
        word = (word & 0xff00ff00u) | (word >> 16u & 0xffu) | (word & 0xffu) << 16u;
    store_element(push.words, index, word);
}

VKPT_RUN_OVER(push.size, show_pixel)
