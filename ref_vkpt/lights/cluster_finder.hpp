// SPDX-License-Identifier: GPL-2.0-or-later
// Which PVS clusters a shape touches.
#pragma once

#include "formats/bsp.hpp"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <vector>

namespace vkpt {

// Where the world's tree begins: a node, or < 0: the leaf -(index + 1).
int32_t find_world_root(const formats::Bsp& bsp);

// Ascending, free of duplicates. A triangle is pushed `lift` units off its front, where its light starts. `steps` grows
// by what the walk took, in nodes that a ball would visit.
std::vector<int> find_touched_clusters(
    const formats::Bsp& bsp, const shared::Emitter& emitter, float lift, uint64_t& steps);

// True if any leaf that the ball overlaps is solid. `steps` as above.
bool touches_solid(const formats::Bsp& bsp, glm::vec3 centre, float radius, uint64_t& steps);

} // namespace vkpt
