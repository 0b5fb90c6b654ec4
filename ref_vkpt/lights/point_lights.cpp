// SPDX-License-Identifier: GPL-2.0-or-later
// Light entities as small spheres: point lights and spots.
#include "formats/byte_reader.hpp"
#include "formats/entities.hpp"
#include "ref_vkpt/lights/cluster_finder.hpp"
#include "ref_vkpt/lights/emitters.hpp"
#include "ref_vkpt/lights/light_aim.hpp"
#include "ref_vkpt/lights/light_entities.hpp"
#include "ref_vkpt/lights/spot_cone.hpp"
#include "ref_vkpt/lights/work_limit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

namespace vkpt {

namespace {

using formats::Bsp;
using formats::EntityText;

constexpr float min_radius = 0.5f;
constexpr int farthest_rescue = 16; // how far a light inside a wall may be moved to come out of it, units
constexpr float default_cone = 10; // degrees between axis and edge
// The classic cone's edge is sharp. Here it fades over so much of the cone's angle, half of it outside.
constexpr float edge_share = 0.1f;
constexpr uint64_t max_placing_steps = 100'000'000; // nodes visited for all lights, per megabyte of the map

// The nearest free place around a light whose origin lies in a wall.
std::optional<glm::vec3> find_free_place(const Bsp& bsp, glm::vec3 origin, uint64_t& steps)
{
    if (!(bsp.leaves[bsp.find_leaf(origin, find_world_root(bsp))].contents & formats::CONTENTS_SOLID))
        return origin;
    for (int step = 1; step <= farthest_rescue; step *= 2)
        for (int z = -1; z <= 1; z++)
            for (int y = -1; y <= 1; y++)
                for (int x = -1; x <= 1; x++) {
                    const glm::vec3 place = origin + float(step) * glm::vec3(x, y, z);
                    if (!touches_solid(bsp, place, min_radius, steps))
                        return place;
                }
    return std::nullopt;
}

// The largest radius, halving from `wanted`, at which the sphere stays clear of walls: buried parts would be lost
// light.
float fit_radius(const Bsp& bsp, glm::vec3 centre, float wanted, uint64_t& steps)
{
    float radius = wanted;
    while (radius > min_radius && touches_solid(bsp, centre, radius, steps))
        radius *= 0.5f;
    return std::max(radius, min_radius);
}

shared::Emitter make_sphere(const EntityText& entity, glm::vec3 centre, float radius, const EmissionScales& scales)
{
    constexpr float pi = std::numbers::pi_v<float>;
    const float value = read_light_value(entity);
    const float intensity = scales.point * value * value * value;
    shared::Emitter emitter {};
    emitter.type = shared::EMITTER_SPHERE;
    emitter.p0 = centre;
    emitter.p1 = glm::vec3(radius, 0, 0);
    emitter.area = 4 * pi * radius * radius;
    emitter.radiance = read_light_colour(entity).value_or(glm::vec3(1)) * (intensity / (pi * radius * radius));
    emitter.lightstyle = read_lightstyle(entity, "style");
    return emitter;
}

void add_cone(shared::Emitter& sphere, const EntityText& entity, glm::vec3 axis)
{
    constexpr float pi = std::numbers::pi_v<float>;
    const float given = entity.number("_cone", entity.number("cone", 0));
    const float cone = (given > 0 ? std::min(given, 180.0f) : default_cone) * pi / 180;
    const float edge = 0.5f * edge_share * cone;
    if (cone + edge < pi)
        set_cone(sphere, axis, std::cos(cone - edge), std::cos(cone + edge));
}

std::string describe(glm::vec3 p) { return fmt::format("{:.0f} {:.0f} {:.0f}", p.x, p.y, p.z); }

} // namespace

std::vector<shared::Emitter> extract_point_lights(
    const Bsp& bsp, const EmissionScales& scales, std::vector<std::string>& messages)
{
    const std::vector<EntityText> entities = read_entities(bsp, messages);
    const TargetPlaces targets = find_target_places(entities);
    std::vector<shared::Emitter> lights;
    size_t number = 0;
    WorkLimit work(bsp, max_placing_steps, "steps to find its point lights' places");
    for (const EntityText& entity : entities) {
        if (!is_light(entity) || is_sun(entity))
            continue;
        number++;
        const std::optional<glm::vec3> origin = entity.vector("origin");
        if (!origin || !std::isfinite(glm::dot(*origin, *origin))) {
            messages.push_back(fmt::format("{}: a light entity without a usable origin is ignored", bsp.name));
            continue;
        }
        const float value = read_light_value(entity);
        if (!(value > 0) || !std::isfinite(value)) {
            messages.push_back(
                fmt::format("{}: the light at {} has the value {} and is ignored: only positive lights emit", bsp.name,
                    describe(*origin), value));
            continue;
        }
        uint64_t steps = 0;
        const std::optional<glm::vec3> place = find_free_place(bsp, *origin, steps);
        const float radius = place ? fit_radius(bsp, *place, scales.point_light_radius, steps) : 0;
        work.spend(steps, "light entity", number);
        if (!place) {
            messages.push_back(fmt::format("{}: the light at {} is inside a wall and is ignored: move it into the room",
                bsp.name, describe(*origin)));
            continue;
        }
        lights.push_back(make_sphere(entity, *place, radius, scales));
        if (const std::optional<glm::vec3> axis = find_aim(entity, *origin, targets))
            add_cone(lights.back(), entity, *axis);
    }
    return lights;
}

} // namespace vkpt
