// SPDX-License-Identifier: GPL-2.0-or-later
// Quake II's textures say nothing of gloss: what a surface is made of is told by files of materials, or guessed from
// its texture's name.
#pragma once

#include <string_view>

namespace vkpt {

struct MaterialDefaults;

struct SurfaceGuess {
    float roughness, metallic;
    float base_factor = 1; // times the texture's colour
};

// `texture`: name as in a texinfo or a skin's path. Names that say nothing get the defaults.
SurfaceGuess guess_surface(std::string_view texture, const MaterialDefaults& defaults);

// What the library says of formats::material_name `name`, in place of what was guessed.
void apply_material(SurfaceGuess& surface, std::string_view name, const MaterialDefaults& defaults);

} // namespace vkpt
