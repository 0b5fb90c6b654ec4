// SPDX-License-Identifier: GPL-2.0-or-later
// What the game does with brush entities when a level starts, as far as it shows: who is visible and where it stands.
#include "client/host/client_map.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace vkpt::client {

namespace {

using formats::BspModel;
using formats::EntityText;

// spawnflags
constexpr uint32_t door_starts_open = 1;
constexpr uint32_t rotates_backwards = 2;
constexpr uint32_t rotates_about_x = 64;
constexpr uint32_t rotates_about_y = 128;
constexpr uint32_t wall_is_switched = 1 | 2 | 4; // trigger spawn, toggle, start on
constexpr uint32_t wall_starts_on = 4;
constexpr uint32_t spawns_when_triggered = 1;
constexpr uint32_t not_in_medium = 0x200;

bool is_visible(const EntityText& entity)
{
    const std::string_view name = entity.class_name();
    const uint32_t flags = spawn_flags(entity);
    if (flags & not_in_medium)
        return false;
    if (name == "func_wall")
        return !(flags & wall_is_switched) || (flags & wall_starts_on);
    if (name == "func_explosive" || name == "func_object")
        return !(flags & spawns_when_triggered);
    if (name == "func_killbox" || name == "func_areaportal")
        return false;
    return name.starts_with("func_");
}

// "angle" of things that move: -1 up, -2 down, else a yaw.
glm::vec3 move_direction(const EntityText& entity)
{
    const float angle = entity.number("angle", 0);
    if (angle == -1)
        return { 0, 0, 1 };
    if (angle == -2)
        return { 0, 0, -1 };
    const float yaw = angle * std::numbers::pi_v<float> / 180;
    return { std::cos(yaw), std::sin(yaw), 0 };
}

// How far a sliding door goes: its own extent along the way, less the lip that stays out.
glm::vec3 slide(const EntityText& entity, const BspModel& model)
{
    const glm::vec3 direction = move_direction(entity);
    const float distance = glm::dot(glm::abs(direction), model.maxs - model.mins) - entity.number("lip", 8);
    return direction * distance;
}

glm::vec3 turn(const EntityText& entity)
{
    const uint32_t flags = spawn_flags(entity);
    const float angle = entity.number("distance", 90) * (flags & rotates_backwards ? -1.0f : 1.0f);
    if (flags & rotates_about_x)
        return { 0, 0, angle };
    if (flags & rotates_about_y)
        return { angle, 0, 0 };
    return { 0, angle, 0 };
}

// A platform that nobody has to switch on waits below.
float lowered_by(const EntityText& entity, const BspModel& model)
{
    if (!entity.get("targetname").empty())
        return 0;
    const float height = entity.number("height", 0);
    return height != 0 ? height : model.maxs.z - model.mins.z - entity.number("lip", 8);
}

std::optional<glm::vec3> find_target(const EntityText& entity, const std::vector<EntityText>& entities)
{
    const std::string_view target = entity.get("target");
    for (const EntityText& other : entities)
        if (!target.empty() && other.get("targetname") == target)
            return other.vector("origin");
    return std::nullopt;
}

} // namespace

uint32_t spawn_flags(const EntityText& entity)
{
    // Maps may hold any number; what the type does not hold has no flags.
    const double number = entity.number("spawnflags", 0);
    return number > -2147483649.0 && number < 4294967296.0 ? uint32_t(int64_t(number)) : 0;
}

std::optional<BrushPlacement> place_brush_model(
    const EntityText& entity, const BspModel& model, const std::vector<EntityText>& entities)
{
    if (!is_visible(entity))
        return std::nullopt;
    BrushPlacement placement { entity.vector("origin").value_or(glm::vec3(0)), glm::vec3(0) };
    const std::string_view name = entity.class_name();
    const bool starts_open = spawn_flags(entity) & door_starts_open;
    if (name == "func_plat")
        placement.origin.z -= lowered_by(entity, model);
    else if (name == "func_train") // its lower corner stands on the first path_corner
        placement.origin = find_target(entity, entities).value_or(placement.origin + model.mins) - model.mins;
    else if ((name == "func_door" || name == "func_water") && starts_open)
        placement.origin += slide(entity, model);
    else if (name == "func_door_rotating" && starts_open)
        placement.angles = turn(entity);
    return placement;
}

} // namespace vkpt::client
