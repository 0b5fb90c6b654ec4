// SPDX-License-Identifier: GPL-2.0-or-later
// The weapons' shapes, used in the hand, on the floor and by the player figure.
#pragma once

#include "tools/asset_generator/mesh.hpp"

#include <span>

namespace vkpt::tools {

struct Gun {
    const char* view; // folder under models/weapons/ for the first person
    const char* pickup; // folder for the floor; nullptr: none
    const char* held; // players/male/NAME.md2
    // Last frames of raising, firing, resting, lowering, as the game counts them.
    int raised, fired, rested, lowered;
    int barrels;
    float length, barrel_radius;
    Material body, barrel, accent;
};

std::span<const Gun> guns();
// Muzzle along +x, grip at the origin, about 20 units long.
Mesh make_gun(const Gun& gun);

} // namespace vkpt::tools
