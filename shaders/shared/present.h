// SPDX-License-Identifier: GPL-2.0-or-later
// The finished image in the window's own format: what present.comp is told.
#ifndef VKPT_SHARED_PRESENT_H
#define VKPT_SHARED_PRESENT_H

#include "language.h"

VKPT_SHARED_BEGIN

// Named from the lowest bits up.
VKPT_CONST uint PRESENT_RGBA8 = 0u;
VKPT_CONST uint PRESENT_BGRA8 = 1u;
VKPT_CONST uint PRESENT_RGB10A2 = 2u;
VKPT_CONST uint PRESENT_BGR10A2 = 3u;
VKPT_CONST uint PRESENT_RGBA16F = 4u; // two words a pixel

// What the window takes a colour for.
VKPT_CONST uint PRESENT_SDR = 0u; // sRGB-encoded
VKPT_CONST uint PRESENT_HDR10 = 1u; // BT.2020, encoded as ST 2084 says
VKPT_CONST uint PRESENT_SCRGB = 2u; // linear, 1 being SCRGB_WHITE
VKPT_CONST float SCRGB_WHITE = 80.0f; // cd/m^2

struct PresentPush {
    uint64_t image; // FrameUniforms::output_words
    uint64_t highlights; // FrameUniforms::highlights, unless PRESENT_SDR
    uint64_t words;
    uvec2 image_size;
    uvec2 size; // of the window; the image is cut or repeated at its edge where they differ for a frame
    uint packing; // PRESENT_RGBA8 and so on
    uint transfer; // PRESENT_SDR, PRESENT_HDR10, PRESENT_SCRGB
    float paper_white; // cd/m^2
    float peak; // cd/m^2
};
VKPT_ASSERT_SIZE(PresentPush, 56);

VKPT_SHARED_END

#endif
