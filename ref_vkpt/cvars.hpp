// SPDX-License-Identifier: GPL-2.0-or-later
// The module's console variables as plain typed fields, checked once a frame. Rows: shaders/shared/cvars.def.
#pragma once

#include "shaders/shared/cvars.h"

#include <string>

namespace vkpt {

#define VKPT_SHADER_INT(name, initial, lowest, highest, keep, help) int name = initial;
#define VKPT_SHADER_FLOAT(name, initial, lowest, highest, keep, help) float name = float(initial);
#define VKPT_SHADER_CHOICE(name, initial, choices, keep, help) std::string name = initial;
#define VKPT_HOST_INT(name, initial, lowest, highest, keep, help) int name = initial;
#define VKPT_HOST_FLOAT(name, initial, lowest, highest, keep, help) float name = float(initial);
#define VKPT_HOST_STRING(name, initial, choices, keep, help) std::string name = initial;
#define VKPT_ENGINE_INT(name, initial, keep, help) int name = initial;
#define VKPT_ENGINE_FLOAT(name, initial, keep, help) float name = float(initial);
#define VKPT_ENGINE_STRING(name, initial, keep, help) std::string name = initial;
struct CvarValues {
#include "shaders/shared/cvars.def"
    bool operator==(const CvarValues&) const = default;
};

namespace cvars {

// Makes the engine know every row, and reads the values that configuration and command line gave. In Init.
void register_all();

// Reads what the player changed since the last call. A value of ours that is malformed or out of range is put right, in
// the engine too, with one console line. Returns whether any value changed. Once a frame.
bool update();

const CvarValues& values();
// Without what the renderer itself writes, every frame.
CvarValues players_values();
// The same numbers for the shaders; choices by their place.
shared::ShaderCvars shader_values();

// Sets a cvar by name from the module's side; values() follows at the next update().
void set(const char* name, const std::string& text);

} // namespace cvars
} // namespace vkpt
