// SPDX-License-Identifier: GPL-2.0-or-later
// Liquids of a map: which one a place is in, and which one a face bounds.
#pragma once

#include "formats/bsp.hpp"
#include "ref_vkpt/lights/face_triangles.hpp"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

// MEDIUM_* of a leaf's contents; what the engine counts as thicker goes first.
uint32_t medium_of_contents(uint32_t contents);

// MEDIUM_* at a point of brush model `model` (0: the world), in its space.
uint32_t medium_at(const formats::Bsp& bsp, glm::vec3 point, size_t model = 0);

// Triangle::medium of a face of brush model `model` (0: the world), by the leaves on its two sides. 0: no liquid's.
// A face whose leaves tell nothing is that of the liquid its texture is named after, else of water, which lies below
// it where it looks up and behind it where it stands.
// `said`: which liquid its material says it is; MEDIUM_NONE: nothing.
uint32_t medium_of_face(const formats::Bsp& bsp, size_t face, size_t model, uint32_t said = shared::MEDIUM_NONE);

// MEDIUM_* for each texinfo, of its first face of a liquid. `textures`: per texinfo, or none.
std::vector<uint32_t> find_texinfo_media(const formats::Bsp& bsp, std::span<const FaceTexture> textures = {});

// Lava without a light value gets one, so that it shines as brightly as the engine's own renderers show it.
void light_lava(formats::Bsp& bsp, const std::vector<uint32_t>& texinfo_media);

// Adds a box to a list of at most MAX_FILTER_BOXES, in which those that grow least together are one.
void add_filter_box(std::vector<shared::FilterBox>& boxes, const shared::FilterBox& box);

// The boxes of the liquids that fill the world's leaves.
std::vector<shared::FilterBox> find_liquid_boxes(const formats::Bsp& bsp);

} // namespace vkpt
