// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/light_entities.hpp"

#include "formats/byte_reader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>

namespace vkpt {

using formats::EntityText;

std::vector<EntityText> read_entities(const formats::Bsp& bsp, std::vector<std::string>& messages)
{
    try {
        return formats::parse_entities(bsp.entity_text, bsp.name);
    } catch (const formats::FormatError& error) {
        messages.push_back(
            fmt::format("{}: no light entities: the entity text cannot be read: {}", bsp.name, error.what()));
        return {};
    }
}

bool is_sun(const EntityText& light) { return light.number("_sun", 0) > 0; }

float read_light_value(const EntityText& light)
{
    constexpr float usual = 300;
    const float value = light.number("light", light.number("_light", usual));
    return value == 0 ? usual : value;
}

std::optional<glm::vec3> read_colour(const EntityText& entity, std::string_view key)
{
    const std::optional<glm::vec3> colour = entity.vector(key);
    if (!colour)
        return std::nullopt;
    const glm::vec3 positive = glm::max(*colour, glm::vec3(0));
    const float greatest = std::max({ positive.x, positive.y, positive.z });
    return greatest > 0 && std::isfinite(greatest) ? std::optional(positive / greatest) : std::nullopt;
}

std::optional<glm::vec3> read_light_colour(const EntityText& light)
{
    return read_colour(light, light.get("_color").empty() ? "color" : "_color");
}

uint32_t read_lightstyle(const EntityText& entity, std::string_view key)
{
    constexpr int style_count = 256;
    const float style = entity.number(key, entity.number(fmt::format("_{}", key), 0));
    return style >= 0 && style < style_count ? uint32_t(style) : 0;
}

} // namespace vkpt
