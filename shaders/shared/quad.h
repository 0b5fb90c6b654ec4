// SPDX-License-Identifier: GPL-2.0-or-later
// The 2D layer (HUD, console, menus, cinematics): rectangles, and which of them each tile of the image meets.
#ifndef VKPT_SHARED_QUAD_H
#define VKPT_SHARED_QUAD_H

#include "language.h"

VKPT_SHARED_BEGIN

VKPT_CONST uint QUAD_TILE_SIZE = 16u; // pixels; a tile is the work of 64 lanes

struct Quad {
    vec2 corner_min; // pixels of the output image, y down; a pixel is inside if its centre is, the far edge excluded
    vec2 corner_max;
    vec2 uv_min;
    vec2 uv_max;
    uint color; // RGBA8, red in the lowest byte, sRGB-encoded like the image; multiplies it
    uint texture_slot; // bindless index
    uint sampler_index; // SAMPLER_*
    uint flags; // QUAD_*
};
VKPT_ASSERT_SIZE(Quad, 48);

VKPT_CONST uint QUAD_OPAQUE = 1u; // hides what lies below it
VKPT_CONST uint QUAD_PLAIN = 2u; // its colour alone, no image

// A tile that some quad touches; its quads in drawing order are quad_indices[first .. first + count).
struct QuadTile {
    uvec2 origin; // pixels
    uint first;
    uint count;
    uint covered; // 1: its first quad hides all of the image below
};
VKPT_ASSERT_SIZE(QuadTile, 20);

struct QuadPush {
    uint64_t quads; // Quad
    uint64_t tiles; // QuadTile, one per workgroup
    uint64_t quad_indices; // uint
    uint64_t output_words; // FrameUniforms::output_words
    uvec2 output_size;
    float intensity; // each colour c is shown as (c * intensity)^exponent
    float exponent;
};
VKPT_ASSERT_SIZE(QuadPush, 48);

VKPT_SHARED_END

#endif
