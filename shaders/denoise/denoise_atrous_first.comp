#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The second level of the spatial filter, which is the last to measure how much the light varies where too few frames
// tell.
#include "../lib/frame.glsl"
#include "denoise_atrous.glsl"

VKPT_RUN_OVER_PIXELS(spread_pixel)
