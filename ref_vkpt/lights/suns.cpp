// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/suns.hpp"

#include "ref_vkpt/lights/light_aim.hpp"
#include "ref_vkpt/lights/light_entities.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <string>

namespace vkpt {

namespace {

using formats::EntityText;

constexpr int max_suns = 9;
constexpr float smallest_diameter = 0.02f, largest_diameter = 60; // degrees

std::string prefix_of(int number) { return number == 1 ? "_sun" : fmt::format("_sun{}", number); }

float half_angle_of(float diameter)
{
    const float sane = diameter > 0 ? std::clamp(diameter, smallest_diameter, largest_diameter) : sun_diameter;
    return glm::radians(0.5f * sane);
}

// From a light that is aimed at the entity that the key names, to that entity.
std::optional<glm::vec3> find_named_aim(
    std::string_view name, std::span<const EntityText> entities, const TargetPlaces& targets)
{
    const auto place = targets.find(name);
    if (name.empty() || place == targets.end())
        return std::nullopt;
    for (const EntityText& entity : entities)
        if (is_light(entity) && entity.get("target") == name)
            if (const std::optional<glm::vec3> origin = entity.vector("origin"))
                return unit_direction(place->second - *origin);
    return std::nullopt;
}

// Where its light goes; straight down unless it is told.
glm::vec3 find_sun_aim(const EntityText& world, const std::string& prefix, std::span<const EntityText> entities,
    const TargetPlaces& targets)
{
    if (const std::optional<glm::vec3> vector = world.vector(prefix + "_vector"))
        return unit_direction(*vector).value_or(glm::vec3(0, 0, -1));
    for (const char* key : { "_angle", "_mangle" })
        if (const std::vector<float> angles = world.numbers(prefix + key); angles.size() >= 2)
            return direction_of_angles(angles[0], angles[1]);
    const std::string_view name = world.get(prefix + "_target", world.get(prefix));
    return find_named_aim(name, entities, targets).value_or(glm::vec3(0, 0, -1));
}

// A later worldspawn's keys replace those of earlier ones.
EntityText merge_worlds(std::span<const EntityText> entities)
{
    EntityText world;
    for (const EntityText& entity : entities)
        if (entity.class_name() == "worldspawn")
            for (const auto& [key, value] : entity.pairs)
                world.pairs.insert_or_assign(key, value);
    return world;
}

void append_sun(std::vector<Sun>& suns, const Sun& sun)
{
    if (sun.light > 0 && std::isfinite(sun.light) && suns.size() < size_t(max_suns))
        suns.push_back(sun);
}

} // namespace

std::vector<Sun> find_suns(std::span<const EntityText> entities)
{
    std::vector<Sun> suns;
    const EntityText world = merge_worlds(entities);
    const TargetPlaces targets = find_target_places(entities);
    for (int number = 1; number <= max_suns; number++) {
        const std::string prefix = prefix_of(number);
        Sun sun;
        sun.light = world.number(prefix + "_light", 0);
        if (!(sun.light > 0))
            continue;
        sun.to_sun = -find_sun_aim(world, prefix, entities, targets);
        sun.colour = read_colour(world, prefix + "_color");
        sun.half_angle = half_angle_of(world.number(prefix + "_penumbra", 0));
        sun.lightstyle = read_lightstyle(world, prefix + "_style");
        append_sun(suns, sun);
    }
    for (const EntityText& entity : entities) {
        if (!is_light(entity) || !is_sun(entity))
            continue;
        Sun sun;
        sun.light = read_light_value(entity);
        sun.to_sun
            = -find_aim(entity, entity.vector("origin").value_or(glm::vec3(0)), targets).value_or(glm::vec3(0, 0, -1));
        sun.colour = read_light_colour(entity);
        sun.half_angle = half_angle_of(entity.number("_penumbra", 0));
        sun.lightstyle = read_lightstyle(entity, "style");
        append_sun(suns, sun);
    }
    return suns;
}

shared::Emitter make_sun(const Sun& sun, glm::vec3 sky_colour)
{
    constexpr float pi = std::numbers::pi_v<float>;
    const float brightest = std::max({ sky_colour.x, sky_colour.y, sky_colour.z });
    const glm::vec3 of_sky = brightest > 0 ? sky_colour / brightest : glm::vec3(1);
    const float sine = std::sin(sun.half_angle), radius = shared::SUN_DISTANCE * sine;
    shared::Emitter emitter {};
    emitter.type = shared::EMITTER_SUN;
    emitter.p0 = sun.to_sun * shared::SUN_DISTANCE;
    emitter.p1.x = radius;
    emitter.area = 4 * pi * radius * radius;
    // A ball of radiance L whose half angle has the sine s sends the irradiance pi L s^2.
    emitter.radiance = sun.colour.value_or(of_sky) * (sun.light / (128 * sine * sine));
    emitter.lightstyle = sun.lightstyle;
    return emitter;
}

} // namespace vkpt
