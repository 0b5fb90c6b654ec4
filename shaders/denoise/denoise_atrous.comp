#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// A level of the spatial filter between the second and the last.
#define VKPT_DEVIATIONS_ARE_KNOWN
#include "../lib/frame.glsl"
#include "denoise_atrous.glsl"

VKPT_RUN_OVER_PIXELS(spread_pixel)
