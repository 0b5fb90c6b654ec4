// SPDX-License-Identifier: GPL-2.0-or-later
// Quake II's textures say nothing of gloss: what a surface is made of is told by files of materials, or guessed from
// its texture's name.
#pragma once

#include "ref_vkpt/lights/face_triangles.hpp"
#include "shaders/shared/scene.h"

#include <string_view>

namespace vkpt {

struct MaterialDefaults;
struct MaterialSettings;

struct SurfaceGuess {
    float roughness, metallic;
    float pane_roughness = -1; // of thin panes; below 0: `roughness`
    float specular_factor = 1; // times what the coat over the base reflects
    float base_factor = 1; // times the texture's colour
    // Where there is a normal map:
    float bump_scale = 1; // of its tilt
    float min_roughness = 0; // below what the texture's alpha says
    float metalness_factor = 1; // times what the map's alpha says; below 0: `metallic` counts instead
    float emissive_factor = 1; // times what glows of skins
};

// `texture`: name as in a texinfo or a skin's path. Names that say nothing get the defaults.
SurfaceGuess guess_surface(std::string_view texture, const MaterialDefaults& defaults);

// What files and the player say, in place of what was guessed; nullptr: nothing.
void apply_material(SurfaceGuess& surface, const MaterialSettings* settings);

// What is missing of the coat's reflectance, 0 to 1.
float coat_loss(const shared::Material& material);

// Tint, roughness, metalness, coat and maps of a material that has its texture.
void set_surface(
    shared::Material& material, const SurfaceGuess& surface, const TextureMaps& maps, const MaterialDefaults& defaults);

} // namespace vkpt
