// SPDX-License-Identifier: GPL-2.0-or-later
// Point light entities as small spheres.
#include "formats/byte_reader.hpp"
#include "formats/entities.hpp"
#include "ref_vkpt/lights/cluster_finder.hpp"
#include "ref_vkpt/lights/emitters.hpp"
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

constexpr float default_light_value = 300;
constexpr float least_radius = 0.5f;
constexpr int farthest_rescue = 16; // how far a light inside a wall may be moved to come out of it, units
constexpr int lightstyle_count = 256;
constexpr uint64_t most_steps = 100'000'000; // nodes visited for all lights, per megabyte of the map

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
                    if (!touches_solid(bsp, place, least_radius, steps))
                        return place;
                }
    return std::nullopt;
}

// The largest radius, halving from `wanted`, at which the sphere stays clear of walls: buried parts would be lost
// light.
float fit_radius(const Bsp& bsp, glm::vec3 centre, float wanted, uint64_t& steps)
{
    float radius = wanted;
    while (radius > least_radius && touches_solid(bsp, centre, radius, steps))
        radius *= 0.5f;
    return std::max(radius, least_radius);
}

glm::vec3 read_colour(const EntityText& entity)
{
    std::optional<glm::vec3> colour = entity.vector("_color");
    if (!colour)
        colour = entity.vector("color");
    if (!colour)
        return glm::vec3(1);
    // Editors write 0..1 or 0..255; the classic compilers scale either to a greatest component of 1.
    const glm::vec3 positive = glm::max(*colour, glm::vec3(0));
    const float greatest = std::max({ positive.x, positive.y, positive.z });
    return greatest > 0 && std::isfinite(greatest) ? positive / greatest : glm::vec3(1);
}

float read_value(const EntityText& entity)
{
    const float value = entity.number("light", entity.number("_light", default_light_value));
    return value == 0 ? default_light_value : value;
}

uint32_t read_lightstyle(const EntityText& entity)
{
    const float style = entity.number("style", entity.number("_style", 0));
    return style >= 0 && style < lightstyle_count ? uint32_t(style) : 0;
}

shared::Emitter make_sphere(const EntityText& entity, glm::vec3 centre, float radius, const EmissionScales& scales)
{
    constexpr float pi = std::numbers::pi_v<float>;
    const float value = read_value(entity);
    const float intensity = scales.point * value * value * value;
    shared::Emitter emitter {};
    emitter.type = shared::EMITTER_SPHERE;
    emitter.p0 = centre;
    emitter.p1 = glm::vec3(radius, 0, 0);
    emitter.area = 4 * pi * radius * radius;
    emitter.radiance = read_colour(entity) * (intensity / (pi * radius * radius));
    emitter.lightstyle = read_lightstyle(entity);
    return emitter;
}

std::vector<EntityText> read_entities(const Bsp& bsp, std::vector<std::string>& messages)
{
    try {
        return formats::parse_entities(bsp.entity_text, bsp.name);
    } catch (const formats::FormatError& error) {
        messages.push_back(
            fmt::format("{}: no point lights: the entity text cannot be read: {}", bsp.name, error.what()));
        return {};
    }
}

std::string describe(glm::vec3 p) { return fmt::format("{:.0f} {:.0f} {:.0f}", p.x, p.y, p.z); }

} // namespace

std::vector<shared::Emitter> extract_point_lights(
    const Bsp& bsp, const EmissionScales& scales, std::vector<std::string>& messages)
{
    std::vector<shared::Emitter> lights;
    size_t spotlights = 0, number = 0;
    WorkLimit work(bsp, most_steps, "steps to find its point lights' places");
    for (const EntityText& entity : read_entities(bsp, messages)) {
        if (entity.class_name() != "light")
            continue;
        number++;
        const std::optional<glm::vec3> origin = entity.vector("origin");
        if (!origin || !std::isfinite(glm::dot(*origin, *origin))) {
            messages.push_back(fmt::format("{}: a light entity without a usable origin is ignored", bsp.name));
            continue;
        }
        const float value = read_value(entity);
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
        if (!entity.get("target").empty() || !entity.get("_cone").empty())
            spotlights++;
        lights.push_back(make_sphere(entity, *place, radius, scales));
    }
    if (spotlights > 0)
        messages.push_back(fmt::format("{}: {} spotlights shine in all directions", bsp.name, spotlights));
    return lights;
}

} // namespace vkpt
