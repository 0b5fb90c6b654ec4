// SPDX-License-Identifier: GPL-2.0-or-later
// The entity string: a list of { "key" "value" ... } blocks, in BSP files and in map sources.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace formats {

struct EntityText {
    std::map<std::string, std::string, std::less<>> pairs;

    std::string_view get(std::string_view key, std::string_view fallback = "") const;
    float number(std::string_view key, float fallback) const; // malformed: fallback
    std::optional<glm::vec3> vector(std::string_view key) const; // "x y z"; malformed: none
    std::vector<float> numbers(std::string_view key) const; // those it begins with
    std::string_view class_name() const { return get("classname"); }
};

// The index of BspModel in a model's name: "*1", "*2" ...
std::optional<size_t> brush_model_index(std::string_view name);

// Throws FormatError (offset = byte in `text`) on an unclosed quote or brace.
std::vector<EntityText> parse_entities(std::string_view text, std::string_view file);

} // namespace formats
