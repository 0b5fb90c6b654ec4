// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/fly_camera.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace vkpt::client::view {

namespace {

constexpr float steepest_pitch = 89;

} // namespace

glm::vec3 forward_of(const Camera& camera)
{
    const float pitch = glm::radians(camera.pitch), yaw = glm::radians(camera.yaw);
    return { std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), -std::sin(pitch) };
}

glm::vec3 right_of(const Camera& camera)
{
    const float yaw = glm::radians(camera.yaw);
    return { std::sin(yaw), -std::cos(yaw), 0 };
}

Camera fly(const Camera& camera, const FlyInput& input, float speed, float seconds)
{
    if (input.move == glm::vec3(0) && input.yaw == 0 && input.pitch == 0)
        return camera;
    Camera result = camera;
    result.pitch = std::clamp(camera.pitch + input.pitch, -steepest_pitch, steepest_pitch);
    result.yaw = std::remainder(camera.yaw + input.yaw, 360.0f);
    glm::vec3 move
        = forward_of(result) * input.move.x + right_of(result) * input.move.y + glm::vec3(0, 0, input.move.z);
    const float length = glm::length(move);
    if (length > 1)
        move /= length;
    result.position += move * (speed * seconds);
    return result;
}

} // namespace vkpt::client::view
