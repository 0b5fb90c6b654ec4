// SPDX-License-Identifier: GPL-2.0-or-later
// Where the entities of a map aim spot lights and suns: the keys of the classic light compilers (qrad3, ArghRad).
#pragma once

#include "formats/entities.hpp"

#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace vkpt {

// Unit; yaw counter-clockwise from the x axis seen from above, pitch upwards.
glm::vec3 direction_of_angles(float yaw_degrees, float pitch_degrees);

// Unit, or nothing for what is too short or not a number.
std::optional<glm::vec3> unit_direction(glm::vec3 direction);

// Places of entities by their "targetname"; the first of a name counts.
using TargetPlaces = std::map<std::string, glm::vec3, std::less<>>;
TargetPlaces find_target_places(std::span<const formats::EntityText> entities);

// The direction in which a light entity at `origin` shines: at its "target", at "_spotpoint", along "_spotvector" or
// the yaw and pitch of "_spotangle" or "_mangle", or for a light_spot along "angle" (-1: up, -2: down). Nothing: it is
// not aimed, and shines all round.
std::optional<glm::vec3> find_aim(const formats::EntityText& light, glm::vec3 origin, const TargetPlaces& targets);

} // namespace vkpt
