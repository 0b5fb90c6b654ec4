#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The finished image in the window's format, from where it is copied into the window. (A scaling or converting blit
// would be drawn, which Mesa's CPU driver cannot do at the vector width that our other passes want.)
#include "lib/frame.glsl"
#include "lib/present_packing.glsl"

VKPT_PUSH_CONSTANTS

void show_pixel(uvec2 pixel, uint index)
{
    uvec2 from = min(pixel, push.image_size - 1u);
    uint at = from.y * push.image_size.x + from.x, word = load_element(push.image, at, 0u);
    uvec2 packed_words;
    if (push.transfer == PRESENT_SDR)
        packed_words = pack_for_window(word, push.packing);
    else
        packed_words = pack_for_hdr_window(word, load_element(push.highlights, at, uvec2(0u)), push.packing,
            push.transfer, push.paper_white, push.peak);
    if (push.packing == PRESENT_RGBA16F) {
        store_element(push.words, 2u * index, packed_words.x);
        store_element(push.words, 2u * index + 1u, packed_words.y);
    } else {
        store_element(push.words, index, packed_words.x);
    }
}

VKPT_RUN_OVER(push.size, show_pixel)
