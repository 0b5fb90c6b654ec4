// SPDX-License-Identifier: GPL-2.0-or-later
// Quake II's pictures say nothing of gloss: what a surface is made of is guessed from its picture's name.
#pragma once

#include <string_view>

namespace vkpt {

struct MaterialDefaults;

struct SurfaceGuess {
    float roughness, metallic;
};

// `texture`: name as in a texinfo or a skin's path. Names that say nothing get the defaults.
SurfaceGuess guess_surface(std::string_view texture, const MaterialDefaults& defaults);

} // namespace vkpt
