// SPDX-License-Identifier: GPL-2.0-or-later
// How much of a map somebody has seen: the leaves that a standing or swimming player can touch, found without the game
// module's own navigation.
#pragma once

#include "formats/bsp.hpp"

#include <glm/vec3.hpp>
#include <set>
#include <vector>

namespace vkpt::tests {

// Leaves, none solid, that a player's box at p overlaps.
void add_touched_leaves(const formats::Bsp& bsp, glm::vec3 p, std::set<size_t>& leaves);

// Of all places where a player can come from the map's spawn points and things: by moves of a box on a lattice that
// never leaves the ground by more than a jump, except downwards.
std::set<size_t> find_reachable_leaves(const formats::Bsp& bsp);

// Along a player's way, frame after frame.
std::set<size_t> find_seen_leaves(const formats::Bsp& bsp, const std::vector<glm::vec3>& way);

} // namespace vkpt::tests
