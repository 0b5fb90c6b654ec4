// SPDX-License-Identifier: GPL-2.0-or-later
// The .map text that level editors save: entities with key/value pairs and brushes given by their planes.
#pragma once

#include "tools/map_compiler/geometry.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt::tools {

// What is wrong with the map, where ("file:line: ..."), and what to do about it.
class MapError : public std::runtime_error {
public:
    MapError(std::string_view file, int line, std::string_view reason);
};

struct MapSide {
    std::array<dvec3, 3> points;
    std::string texture;
    // Classic sides give shift, rotation and scale on an axis pair that follows from the plane; Valve-220 sides give
    // axes.
    bool valve_axes = false;
    std::array<dvec3, 2> axes { dvec3(0), dvec3(0) };
    std::array<double, 2> shift { 0, 0 }, scale { 1, 1 };
    double rotation = 0; // degrees
    struct Surface {
        uint32_t contents = 0, flags = 0;
        int value = 0;
    };
    std::optional<Surface> surface; // set where the side has its own: overrides the texture's
    int line = 0;
};

struct MapBrushSource {
    std::vector<MapSide> sides;
    int line = 0;
};

struct MapEntity {
    std::vector<std::pair<std::string, std::string>> pairs; // in the file's order
    std::vector<MapBrushSource> brushes;
    int line = 0;

    std::string_view get(std::string_view key, std::string_view fallback = "") const;
    void set(std::string_view key, std::string value);
    double number(std::string_view key, double fallback) const;
    std::optional<dvec3> vector(std::string_view key) const;
    std::string_view class_name() const { return get("classname"); }
};

struct MapSource {
    std::string file;
    std::vector<MapEntity> entities; // 0 is the world

    [[noreturn]] void fail(int line, std::string_view reason) const { throw MapError(file, line, reason); }
};

// Throws MapError.
MapSource parse_map(std::string_view text, std::string_view file);

} // namespace vkpt::tools
