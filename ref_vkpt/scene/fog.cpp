// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/fog.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <optional>

namespace vkpt {

namespace {

constexpr float max_density = 10; // per unit; nothing is seen through it
const glm::vec3 usual_radiance(0.5f, 0.55f, 0.6f);

bool is_sane(glm::vec3 v) { return std::isfinite(glm::dot(v, v)); }

// What is wrong with it goes to `fault`.
std::optional<shared::FogBox> read_fog_box(const formats::EntityText& entity, std::string& fault)
{
    const std::optional<glm::vec3> mins = entity.vector("mins"), maxs = entity.vector("maxs");
    if (!mins || !maxs || !is_sane(*mins) || !is_sane(*maxs) || !glm::all(glm::lessThan(*mins, *maxs))) {
        fault = "needs \"mins\" and \"maxs\", each smaller than the other";
        return std::nullopt;
    }
    const float density = entity.number("density", 0), end = entity.number("density2", density);
    if (!(density >= 0 && end >= 0 && density <= max_density && end <= max_density && density + end > 0)) {
        fault = fmt::format("needs a \"density\" above 0 and no greater than {}", max_density);
        return std::nullopt;
    }
    const std::string_view name = entity.get("axis", "z");
    if (name != "x" && name != "y" && name != "z") {
        fault = "has an \"axis\" that is not x, y or z";
        return std::nullopt;
    }
    const int axis = name[0] - 'x';
    shared::FogBox box { *mins, density, *maxs, glm::vec3(0), usual_radiance };
    box.gradient[axis] = (end - density) / ((*maxs)[axis] - (*mins)[axis]);
    box.density -= box.gradient[axis] * (*mins)[axis];
    if (const std::optional<glm::vec3> colour = entity.vector("_color"); colour && is_sane(*colour))
        box.radiance = glm::max(*colour, glm::vec3(0));
    return box;
}

} // namespace

std::vector<shared::FogBox> find_fog_boxes(
    std::span<const formats::EntityText> entities, const std::string& map, std::vector<std::string>& messages)
{
    std::vector<shared::FogBox> boxes;
    size_t number = 0;
    for (const formats::EntityText& entity : entities) {
        if (entity.class_name() != "fog_box")
            continue;
        number++;
        std::string fault;
        const std::optional<shared::FogBox> box = read_fog_box(entity, fault);
        if (!box)
            messages.push_back(fmt::format("{}: fog_box number {} {}; it is left out", map, number, fault));
        else if (boxes.size() == shared::MAX_FOG_BOXES)
            messages.push_back(fmt::format(
                "{}: fog_box number {} is left out: a map has at most {}", map, number, shared::MAX_FOG_BOXES));
        else
            boxes.push_back(*box);
    }
    return boxes;
}

} // namespace vkpt
