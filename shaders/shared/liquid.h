// SPDX-License-Identifier: GPL-2.0-or-later
// What liquids look like. Lengths in Quake units, angles in radians, times in seconds.
#ifndef VKPT_SHARED_LIQUID_H
#define VKPT_SHARED_LIQUID_H

#include "language.h"

VKPT_SHARED_BEGIN

// Textures of liquids: each coordinate (1 = one texture) is displaced by WARP_AMPLITUDE * sin(WARP_FREQUENCY * the
// other + WARP_SPEED * time).
VKPT_CONST float WARP_AMPLITUDE = 0.0625f;
VKPT_CONST float WARP_FREQUENCY = 6.2831853f;
VKPT_CONST float WARP_SPEED = 1.0f;

VKPT_CONST float WATER_INDEX = 1.33f; // of refraction
VKPT_CONST float GLASS_INDEX = 1.5f;
// What liquids absorb per unit of length (a unit is about an inch), times pt_water_density. Q2RTX's values.
VKPT_CONST vec3 WATER_ABSORPTION = vec3(0.035f, 0.013f, 0.012f); // red goes first
VKPT_CONST vec3 SLIME_ABSORPTION = vec3(0.200f, 0.010f, 0.050f);
VKPT_CONST vec3 LAVA_ABSORPTION = vec3(0.001f, 0.100f, 0.300f);

// Waves of surfaces: the slope of the height is the sum of wave.w * cos(dot(place, wave.xy) + wave.z * time) *
// direction. `place`: x and y where the surface lies flat, along it and upwards where it stands.
VKPT_CONST vec4 WATER_WAVE_A
    = vec4(0.050f, 0.031f, 1.3f, 0.020f); // wave vector (x, y), angular speed, amplitude of the slope
VKPT_CONST vec4 WATER_WAVE_B = vec4(-0.043f, 0.071f, 1.7f, 0.016f);
VKPT_CONST vec4 WATER_WAVE_C = vec4(0.131f, -0.083f, 2.6f, 0.010f);
VKPT_CONST vec2 WATER_SLOPE_A = vec2(0.85f, 0.53f); // its direction
VKPT_CONST vec2 WATER_SLOPE_B = vec2(-0.52f, 0.85f);
VKPT_CONST vec2 WATER_SLOPE_C = vec2(0.84f, -0.54f);

// Caustics: the mean of three sets of bright lines. The phase of a set is dot(place, lines.xy) + lines.z * time +
// CAUSTIC_BEND * sin(dot(place, bend.xy) + bend.z * time).
VKPT_CONST vec3 CAUSTIC_LINES_A = vec3(0.151f, 0.047f, 0.9f);
VKPT_CONST vec3 CAUSTIC_LINES_B = vec3(-0.113f, 0.127f, -1.1f);
VKPT_CONST vec3 CAUSTIC_LINES_C = vec3(-0.029f, -0.171f, 1.3f);
VKPT_CONST vec3 CAUSTIC_BENDS_A = vec3(-0.061f, 0.109f, 1.0f);
VKPT_CONST vec3 CAUSTIC_BENDS_B = vec3(0.097f, 0.083f, -0.8f);
VKPT_CONST vec3 CAUSTIC_BENDS_C = vec3(0.119f, -0.037f, 0.7f);
VKPT_CONST float CAUSTIC_BEND = 1.3f; // radians
VKPT_CONST float CAUSTIC_SHARPNESS = 0.8f; // 0: even light, towards 1: thin lines
VKPT_CONST float CAUSTIC_DEPTH = 16.0f; // where half of that is reached

VKPT_SHARED_END

#endif
