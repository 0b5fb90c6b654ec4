// SPDX-License-Identifier: GPL-2.0-or-later
// What present.comp is told.
#ifndef VKPT_SHARED_PRESENT_H
#define VKPT_SHARED_PRESENT_H

#include "language.h"

VKPT_SHARED_BEGIN

struct PresentPush {
    uint64_t picture; // FrameUniforms::output_words
    uint64_t words;   // the same in the window's byte order
    uvec2 picture_size;
    uvec2 size; // of the window; the picture is cut or repeated at its edge where they differ for a frame
    uint swap_red_blue;
};
VKPT_ASSERT_SIZE(PresentPush, 40);

VKPT_SHARED_END

#endif
