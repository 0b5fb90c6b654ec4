// SPDX-License-Identifier: GPL-2.0-or-later
// Where moving things were in the view before. Entities have no names that last: one is recognised by its model, its
// flags and its place.
#pragma once

#include "ref_vkpt/scene/snapshot.hpp"

namespace vkpt {

// Farther than this (Quake units) nothing moves between two views; it is then taken for another thing.
inline constexpr float max_movement = 96;

// Gives now.moving the poses of the view before. What was not there has not moved.
void find_previous_poses(SceneSnapshot& now, const SceneSnapshot& before);

} // namespace vkpt
