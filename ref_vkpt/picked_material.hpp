// SPDX-License-Identifier: GPL-2.0-or-later
// What the surface under the crosshair is made of: a wall of the map, a door or lift, or a model.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace vkpt {

struct Module;
struct Texture;

struct PickedMaterial {
    std::string name; // formats::material_name, of a wall's texture or a skin
    uint32_t material = 0; // of the view's snapshot
    const Texture* texture = nullptr; // that is shown; nullptr: none, as on skies
    std::optional<uint32_t> texinfo; // of a wall
};

// By the last view, without the device: nothing of its images is disturbed. What has no material (particles, sprites,
// beams) and the player's own weapon are looked through; holes in textures are not. Nothing: no surface is there, or
// there was no view. Takes about a millisecond.
std::optional<PickedMaterial> pick_material(Module& module);

} // namespace vkpt
