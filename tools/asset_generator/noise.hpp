// SPDX-License-Identifier: GPL-2.0-or-later
// Seamless noise over the unit tile: everything here repeats with period 1 in u and v, and depends on the seed alone.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

namespace vkpt::tools {

uint32_t hash_integers(uint32_t x, uint32_t y, uint32_t seed);
float hash_unit(int x, int y, uint32_t seed); // 0..1

// Smooth noise with `cells` lattice cells per tile and axis; 0..1, mean 0.5.
float smooth_noise(glm::vec2 uv, glm::ivec2 cells, uint32_t seed);
// Sum of octaves, each with twice the cells and half the weight of the one before; 0..1.
float fractal_noise(glm::vec2 uv, glm::ivec2 cells, int octaves, uint32_t seed);
inline float fractal_noise(glm::vec2 uv, int cells, int octaves, uint32_t seed)
{
    return fractal_noise(uv, glm::ivec2(cells), octaves, seed);
}

// Distances (in cells) to the nearest and second nearest feature point of a jittered grid.
struct CellNoise {
    float nearest = 0, second = 0;
    uint32_t id = 0; // of the nearest point's cell
};
CellNoise cell_noise(glm::vec2 uv, int cells, uint32_t seed);

} // namespace vkpt::tools
