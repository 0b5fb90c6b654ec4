// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/light_aim.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace vkpt {

using formats::EntityText;

glm::vec3 direction_of_angles(float yaw_degrees, float pitch_degrees)
{
    const float yaw = glm::radians(yaw_degrees), pitch = glm::radians(pitch_degrees);
    return { std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch) };
}

std::optional<glm::vec3> unit_direction(glm::vec3 direction)
{
    const float length = glm::length(direction);
    if (!std::isfinite(length) || !(length > 1e-6f))
        return std::nullopt;
    return direction / length;
}

TargetPlaces find_target_places(std::span<const EntityText> entities)
{
    TargetPlaces places;
    for (const EntityText& entity : entities)
        if (const std::optional<glm::vec3> origin = entity.vector("origin");
            origin && !entity.get("targetname").empty())
            places.try_emplace(std::string(entity.get("targetname")), *origin);
    return places;
}

namespace {

glm::vec3 find_classic_angle(const EntityText& light)
{
    const float angle = light.number("angle", 0);
    return angle == -1 ? glm::vec3(0, 0, 1) : angle == -2 ? glm::vec3(0, 0, -1) : direction_of_angles(angle, 0);
}

} // namespace

std::optional<glm::vec3> find_aim(const EntityText& light, glm::vec3 origin, const TargetPlaces& targets)
{
    if (const auto target = targets.find(light.get("target")); target != targets.end())
        return unit_direction(target->second - origin);
    if (const std::optional<glm::vec3> point = light.vector("_spotpoint"))
        return unit_direction(*point - origin);
    if (const std::optional<glm::vec3> vector = light.vector("_spotvector"))
        return unit_direction(*vector);
    for (const std::string_view key : { "_spotangle", "_mangle" })
        if (const std::vector<float> angles = light.numbers(key); !angles.empty())
            return unit_direction(direction_of_angles(angles[0], angles.size() > 1 ? angles[1] : 0));
    if (light.class_name() == "light_spot")
        return find_classic_angle(light);
    return std::nullopt;
}

} // namespace vkpt
