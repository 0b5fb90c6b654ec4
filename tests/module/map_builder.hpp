// SPDX-License-Identifier: GPL-2.0-or-later
// Maps for pictures: polygons in one open leaf that sees itself. Nothing blocks but the polygons.
#pragma once

#include "formats/bsp.hpp"

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <utility>
#include <vector>

namespace vkpt::tests {

using Polygon = std::vector<glm::vec3>; // counter-clockwise seen from its front
using Pairs = std::vector<std::pair<std::string, std::string>>;

// A rectangle around `centre`, facing along cross(half_a, half_b).
Polygon rectangle(glm::vec3 centre, glm::vec3 half_a, glm::vec3 half_b);

class MapBuilder {
public:
    MapBuilder();
    // Returns its number.
    uint16_t add_material(const std::string& texture, uint32_t flags = 0, int value = 0);
    void add(const Polygon& polygon, uint16_t material);
    void add_room(glm::vec3 mins, glm::vec3 maxs, uint16_t material); // six walls that face inwards
    // A room of 256 x 256 x 128 around the origin with a lamp (texture "lamp") of 32 x 32 under its ceiling.
    void add_lit_room(const std::string& wall);
    void add_block(glm::vec3 mins, glm::vec3 maxs, uint16_t material); // six sides that face outwards
    // What is added from here on belongs to the next brush model ("*1", "*2", ...).
    void begin_brush_model();
    void add_entity(const Pairs& pairs);
    void add_point_light(glm::vec3 origin, float light, int style = 0);
    formats::Bsp finish();

private:
    void add_box(glm::vec3 mins, glm::vec3 maxs, uint16_t material, bool inwards);

    formats::Bsp bsp_;
};

} // namespace vkpt::tests
