// SPDX-License-Identifier: GPL-2.0-or-later
// Each list's static lights as a binary tree of bounds, for samplers that descend it (Conty Estevez and Kulla,
// "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018). The map's emitters are put in one order in
// which neighbours are near each other; each tree divides its lights in that order, so that a light's place there tells
// the way to it.
#pragma once

#include "shaders/shared/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

struct LightTrees {
    std::vector<shared::LightTreeNode> nodes;
    // One per list: which of the nodes its tree begins with. A list without lights has no tree.
    std::vector<uint32_t> roots;
    // As long as the static indices, each list where it is there: its emitters in the tree's order, and for each of its
    // places the place in that order.
    std::vector<uint32_t> lights, places;
};

// At map load, for the static part of all lists (see LightLists).
LightTrees make_light_trees(std::span<const shared::LightList> lists, std::span<const uint32_t> static_indices,
    std::span<const shared::Emitter> static_emitters);

} // namespace vkpt
