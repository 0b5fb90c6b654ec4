// SPDX-License-Identifier: GPL-2.0-or-later
// The layout of the blue-noise masks in memory: words, [pair of masks][slice][y][x]. A word holds the 16-bit values of
// two masks at one voxel, the even mask in the low half.
#ifndef VKPT_SHARED_NOISE_H
#define VKPT_SHARED_NOISE_H

#include "language.h"

VKPT_SHARED_BEGIN

VKPT_CONST uint BLUE_NOISE_SIZE = 64u; // pixels across and down; masks repeat
VKPT_CONST uint BLUE_NOISE_SLICES = 16u; // frames until a mask repeats
VKPT_CONST uint BLUE_NOISE_MASKS = 4u; // independent of each other
VKPT_CONST uint BLUE_NOISE_WORDS = BLUE_NOISE_MASKS / 2u * BLUE_NOISE_SLICES * BLUE_NOISE_SIZE * BLUE_NOISE_SIZE;

VKPT_SHARED_END

#endif
