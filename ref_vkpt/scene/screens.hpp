// SPDX-License-Identifier: GPL-2.0-or-later
// Screens of a map that show what its security cameras see: faces whose material says so (kind CAMERA), in maps with a
// file of cameras (formats/camera_file.hpp).
#pragma once

#include "ref_vkpt/scene/material_library.hpp"
#include "ref_vkpt/scene/world.hpp"

#include <vector>

namespace vkpt {

// Screens that show all cameras by turns show each for so many seconds.
inline constexpr float seconds_per_camera = 4;

// The camera whose picture screens of this texinfo show: the one that the face's value names, counted from 1, where it
// is no light's value; else all by turns. There must be a camera.
size_t choose_camera(const World& world, size_t texinfo, float time);

// What the screen is told of its camera: the picture has the proportions of `area` on a texture of `texture_size`
// texels.
shared::Screen make_screen(
    const World& world, const formats::SecurityCamera& camera, glm::vec4 area, glm::uvec2 texture_size);

// Marks the world's materials (make_materials) that are screens with MATERIAL_SCREEN and the number of their entry in
// the result. Beyond MAX_SCREENS screens show their texture.
std::vector<shared::Screen> find_screens(
    const World& world, const MaterialLibrary& library, float time, std::vector<shared::Material>& materials);

} // namespace vkpt
