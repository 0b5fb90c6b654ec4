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

#define VKPT_CHOICE_CONSTANT(constant, number, text) VKPT_CONST int constant = number;
#define VKPT_SHADER_CHOICE(name, initial, choices, keep, help) choices(VKPT_CHOICE_CONSTANT)
#include "cvars.def"
#undef VKPT_CHOICE_CONSTANT

VKPT_SHARED_END

#endif
