// SPDX-License-Identifier: GPL-2.0-or-later
// Map sources for the tests, written as an editor would.
#pragma once

#include "formats/bsp.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <utility>
#include <vector>

namespace vkpt::tests {

using Pairs = std::vector<std::pair<std::string, std::string>>;

struct Box {
    glm::ivec3 mins, maxs;
};

// One side: three points, clockwise seen from outside. `surface`: " contents flags value" or nothing.
std::string side_text(
    glm::ivec3 a, glm::ivec3 b, glm::ivec3 c, const std::string& texture, const std::string& surface = "");
std::string box_brush(const Box& box, const std::string& texture, const std::string& surface = "");
// An upright prism over a polygon given counter-clockwise from above.
std::string prism_brush(const std::vector<glm::ivec2>& base, int bottom, int top, const std::string& texture);
// Solid everywhere but in the `air` boxes, which share no walls with the outside.
std::string walls_around(const std::vector<Box>& air, const std::string& texture);
std::string entity_text(const Pairs& pairs, const std::string& brushes = "");

// Rooms A and B joined by a doorway (door, wall 256..288 thick), room C behind a bend that A cannot see into.
namespace two_rooms {
const Box room_a { { -256, -256, 0 }, { 256, 256, 192 } };
const Box room_b { { 288, -256, 0 }, { 800, 256, 192 } };
const Box room_c { { -256, 320, 0 }, { 256, 600, 192 } };
const Box doorway { { 256, -48, 0 }, { 288, 48, 112 } };
const Box pit { { -224, -224, -96 }, { -64, -64, 0 } };
constexpr int water_level = -8;
const glm::vec3 start { 64, 0, 24 };
const glm::vec3 lamp_in_b { 532, -32, 184 };
const glm::vec3 light_in_c { 0, 460, 150 };
std::string text();
}

// Room A without its ceiling, and a player at (0 0 24).
std::string open_room_text();

// Compiled, written and read again.
formats::Bsp compile(const std::string& text);
formats::Bsp compile_dark(const std::string& text); // no light

} // namespace vkpt::tests
