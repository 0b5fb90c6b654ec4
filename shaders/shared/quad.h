// SPDX-License-Identifier: GPL-2.0-or-later
// A rectangle of the 2D layer (HUD, console, menus, cinematics).
#ifndef VKPT_SHARED_QUAD_H
#define VKPT_SHARED_QUAD_H

#include "language.h"

VKPT_SHARED_BEGIN

struct Quad {
    vec2 corner_min; // pixels of the output picture, y down
    vec2 corner_max;
    vec2 uv_min;
    vec2 uv_max;
    uint color;         // RGBA8, red in the lowest byte, sRGB-encoded like the picture; multiplies it
    uint texture_slot;  // bindless index
    uint sampler_index; // SAMPLER_*
};
VKPT_ASSERT_SIZE(Quad, 44);

struct QuadPush {
    uint64_t quads;       // address of the first
    vec2 clip_per_pixel;  // 2 / size of the output picture
};
VKPT_ASSERT_SIZE(QuadPush, 16);

VKPT_SHARED_END

#endif
