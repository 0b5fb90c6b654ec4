// SPDX-License-Identifier: GPL-2.0-or-later
// What liquids look like. Lengths in Quake units, angles in radians, times in seconds.
#ifndef VKPT_SHARED_LIQUID_H
#define VKPT_SHARED_LIQUID_H

#include "language.h"

VKPT_SHARED_BEGIN

// Pictures of liquids: each coordinate (1 = one picture) is displaced by WARP_AMPLITUDE * sin(WARP_FREQUENCY * the
// other + WARP_SPEED * time).
VKPT_CONST float WARP_AMPLITUDE = 0.0625f;
VKPT_CONST float WARP_FREQUENCY = 6.2831853f;
VKPT_CONST float WARP_SPEED = 1.0f;

VKPT_CONST float WATER_INDEX = 1.33f; // of refraction
VKPT_CONST vec3 WATER_ABSORPTION
    = vec3(0.0045f, 0.0016f, 0.0010f); // per unit of length (a unit is about an inch); red goes first

// Waves of surfaces that lie flat: the slope of the height is the sum of wave.w * cos(dot(place.xy, wave.xy) + wave.z *
// time) * direction.
VKPT_CONST vec4 WATER_WAVE_A
    = vec4(0.050f, 0.031f, 1.3f, 0.020f); // wave vector (x, y), angular speed, amplitude of the slope
VKPT_CONST vec4 WATER_WAVE_B = vec4(-0.043f, 0.071f, 1.7f, 0.016f);
VKPT_CONST vec4 WATER_WAVE_C = vec4(0.131f, -0.083f, 2.6f, 0.010f);
VKPT_CONST vec2 WATER_SLOPE_A = vec2(0.85f, 0.53f); // its direction
VKPT_CONST vec2 WATER_SLOPE_B = vec2(-0.52f, 0.85f);
VKPT_CONST vec2 WATER_SLOPE_C = vec2(0.84f, -0.54f);

VKPT_SHARED_END

#endif
