// SPDX-License-Identifier: GPL-2.0-or-later
// The entities of a map that light it, and what they have in common.
#pragma once

#include "formats/bsp.hpp"
#include "formats/entities.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

// None, and a message, where the text cannot be read.
std::vector<formats::EntityText> read_entities(const formats::Bsp& bsp, std::vector<std::string>& messages);

// The classic compilers take every class whose name begins so, light_mine1 included.
inline bool is_light(const formats::EntityText& entity) { return entity.class_name().starts_with("light"); }

// Whether a light entity is a sun, and so no lamp.
bool is_sun(const formats::EntityText& light);

float read_light_value(const formats::EntityText& light); // "light" or "_light"

// Editors write 0..1 or 0..255; the classic compilers scale either to a greatest component of 1.
std::optional<glm::vec3> read_colour(const formats::EntityText& entity, std::string_view key);
std::optional<glm::vec3> read_light_colour(const formats::EntityText& light); // "_color" or "color"

// 0, the steady one, where `key` says nothing.
uint32_t read_lightstyle(const formats::EntityText& entity, std::string_view key);

} // namespace vkpt
