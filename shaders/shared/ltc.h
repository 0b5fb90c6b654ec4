// SPDX-License-Identifier: GPL-2.0-or-later
// The table of linearly transformed cosines that tools/fit_ltc makes and lib/light_weights.glsl reads.
#ifndef VKPT_SHARED_LTC_H
#define VKPT_SHARED_LTC_H

#include "language.h"

VKPT_SHARED_BEGIN

// Entries of LTC_VALUES floats, LTC_SIZE x LTC_SIZE, row by row: the row is (roughness - LTC_MIN_ROUGHNESS) /
// (1 - LTC_MIN_ROUGHNESS), the column sqrt(1 - cosine of the view), both 0..1 from the first to the last entry.
VKPT_CONST uint LTC_SIZE = 16u;
VKPT_CONST uint LTC_VALUES = 6u;
VKPT_CONST float LTC_MIN_ROUGHNESS = 0.1f;

// Values: the inverse matrix (xx, xz, yy, zx; zz = 1, the others 0) in the frame with z along the normal and the view
// in the xz plane; then the lobe's albedo for a Fresnel factor of 1, and the part of it that goes with Schlick's (1 -
// cosine)^5.

VKPT_SHARED_END

#endif
