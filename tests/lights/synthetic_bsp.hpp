// SPDX-License-Identifier: GPL-2.0-or-later
// Maps made of square cells, for tests of what needs a BSP tree and a PVS.
#pragma once

#include "formats/bsp.hpp"

#include <cstdint>
#include <random>
#include <vector>

namespace vkpt::test {

inline constexpr float cell_size = 128;

// A grid of size x size cells, each open (with a cluster of its own) or solid; floor at z = 0, ceiling at z =
// cell_size, solid all around. Clusters see each other if a walk through open cells joins them. Face i is the floor of
// open cell i, facing up, with texinfo i % 4: plain, light 100, light 200, sky.
formats::Bsp make_cell_map(int size, const std::vector<bool>& open);

std::vector<bool> make_random_cells(int size, double open_share, uint32_t seed);

// Adds a face with this outline (in face_polygon's order) and returns its index.
size_t add_face(formats::Bsp& bsp, const std::vector<glm::vec3>& outline, glm::vec3 normal, uint32_t texinfo);

// True if the straight line from a to b meets no solid leaf and does not cross the surface of an opaque liquid.
bool is_line_clear(const formats::Bsp& bsp, glm::vec3 a, glm::vec3 b);

} // namespace vkpt::test
