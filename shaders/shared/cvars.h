// SPDX-License-Identifier: GPL-2.0-or-later
// The console variables that shaders see, as one struct for both sides (scalar layout). Rows: cvars.def.
#ifndef VKPT_SHARED_CVARS_H
#define VKPT_SHARED_CVARS_H

#include "language.h"

VKPT_SHARED_BEGIN

#define VKPT_SHADER_INT(name, initial, lowest, highest, keep, help) int name;
#define VKPT_SHADER_FLOAT(name, initial, lowest, highest, keep, help) float name;
#define VKPT_SHADER_CHOICE(name, initial, choices, keep, help) int name;
struct ShaderCvars {
#include "cvars.def"
};

// Places in the choices of pt_noise, pt_light_weight, pt_light_point, pt_tone_map, flt_denoiser and pt_debug_view;
// cvars.cpp asserts that they agree with the rows.
VKPT_CONST int LIGHT_WEIGHT_CHAPTER = 0;
VKPT_CONST int LIGHT_WEIGHT_LTC = 1;

VKPT_CONST int LIGHT_POINT_AREA = 0;
VKPT_CONST int LIGHT_POINT_SOLID_ANGLE = 1;
VKPT_CONST int LIGHT_POINT_PROJECTED = 2;

VKPT_CONST int NOISE_BLUE = 0;
VKPT_CONST int NOISE_WHITE = 1;

VKPT_CONST int TONE_MAP_NONE = 0;
VKPT_CONST int TONE_MAP_FILMIC = 1;

VKPT_CONST int DENOISER_OFF = 0;
VKPT_CONST int DENOISER_TEMPORAL = 1;
VKPT_CONST int DENOISER_SVGF = 2;
VKPT_CONST int DENOISER_ASVGF = 3;

VKPT_CONST int DEBUG_VIEW_OFF = 0;
VKPT_CONST int DEBUG_VIEW_ALBEDO = 1;
VKPT_CONST int DEBUG_VIEW_NORMAL = 2;
VKPT_CONST int DEBUG_VIEW_DEPTH = 3;
VKPT_CONST int DEBUG_VIEW_EMISSION = 4;
VKPT_CONST int DEBUG_VIEW_CLUSTER = 5;
VKPT_CONST int DEBUG_VIEW_LIST_LENGTH = 6;
VKPT_CONST int DEBUG_VIEW_IRRADIANCE = 7;
VKPT_CONST int DEBUG_VIEW_ROUGHNESS = 8;
VKPT_CONST int DEBUG_VIEW_MOTION = 9;
VKPT_CONST int DEBUG_VIEW_VARIANCE = 10;
VKPT_CONST int DEBUG_VIEW_GRADIENT = 11;
VKPT_CONST int DEBUG_VIEW_ALPHA = 12;
VKPT_CONST int DEBUG_VIEW_RAYS = 13;

VKPT_SHARED_END

#endif
