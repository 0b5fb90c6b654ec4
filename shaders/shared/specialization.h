// SPDX-License-Identifier: GPL-2.0-or-later
// Specialization constants beside that of shared/texels.h: the kind of device, and settings that stay for minutes,
// which GPUs' pipelines are compiled for (vulkan/pipelines.hpp). Their code is then a third as long, and takes fewer
// registers.
#ifndef VKPT_SHARED_SPECIALIZATION_H
#define VKPT_SHARED_SPECIALIZATION_H

#include "language.h"

VKPT_SHARED_BEGIN

VKPT_CONST uint LIGHT_WEIGHT_CONSTANT = 2u; // pt_light_weight
VKPT_CONST uint LIGHT_POINT_CONSTANT = 3u; // pt_light_point

VKPT_CONST uint BOUNCES_CONSTANT = 4u; // pt_bounces

VKPT_CONST uint GPU_LANES_CONSTANT = 5u; // lib/device/lanes.glsl

VKPT_CONST uint INDIRECT_CONSTANT = 6u; // pt_indirect

VKPT_CONST uint SCREENS_CONSTANT = 7u; // 0: no material is a MATERIAL_SCREEN

VKPT_CONST int NOT_FIXED = -1; // read from the frame's settings

VKPT_SHARED_END

#endif
