// SPDX-License-Identifier: GPL-2.0-or-later
// A camera that flies through walls. Quake space: x east, y north, z up; degrees, positive pitch looks down.
#pragma once

#include "client/host/client_map.hpp"

namespace vkpt::client::view {

// What the user wants of the camera at the moment.
struct FlyInput {
    glm::vec3 move { 0 }; // forward, right, up: -1 to 1 each; up is the world's
    float yaw = 0, pitch = 0; // degrees to turn by, at once
};

inline constexpr float slowest_speed = 20, fastest_speed = 4000; // units per second

glm::vec3 forward_of(const Camera& camera);
glm::vec3 right_of(const Camera& camera);

// The camera `seconds` later. Diagonal movement is no faster; the pitch stops short of straight up and down, the yaw
// stays within -180 to 180. Without input it is the same, also where its angles lie outside of these, as recorded ones
// may.
Camera fly(const Camera& camera, const FlyInput& input, float speed, float seconds);

} // namespace vkpt::client::view
