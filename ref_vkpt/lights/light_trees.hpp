// SPDX-License-Identifier: GPL-2.0-or-later
// Each list's static lights as a binary tree of bounds, for samplers that descend it (Conty Estevez and Kulla,
// "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018). The map's emitters are put in one order in
// which neighbours are near each other; each tree divides its lights in that order, so that a light's place there tells
// the way to it.
#pragma once

#include "ref_vkpt/lights/light_lists.hpp"
#include "shaders/shared/scene.h"

#include <span>
#include <vector>

namespace vkpt {

struct LightTrees {
    std::vector<shared::LightTreeNode> nodes;
    std::vector<uint32_t>
        roots; // one per list: which of the nodes its tree begins with. A list without lights has no tree.
    // As long as LightLists::static_indices(), each list where it is there: its emitters in the tree's order, and for
    // each of its places the place in that order.
    std::vector<uint32_t> lights, places;
};

// At map load, for the static lists.
LightTrees make_light_trees(const LightLists& lists, std::span<const shared::Emitter> static_emitters);
// Of a single list, which is all of `indices`.
LightTrees make_light_tree(std::span<const uint32_t> indices, std::span<const shared::Emitter> emitters);

} // namespace vkpt
