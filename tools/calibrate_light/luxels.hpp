// SPDX-License-Identifier: GPL-2.0-or-later
// The sample points of a map's lightmaps, in the world.
#pragma once

#include "formats/bsp.hpp"

#include <cstdint>
#include <vector>

namespace vkpt::tools {

struct Luxel {
    size_t face;
    glm::vec3 position; // on the face
    glm::vec3 normal;
    glm::vec3 baked; // irradiance / pi: lightmap value / 128, of lightstyle 0, without the map's ambient light
};

// The luxels of the world's faces that tell something: steady light only, inside of their face (lightmaps reach
// beyond), in the open, neither clipped at the lightmap's upper end nor too dark to be told from rounding. Faces that
// emit are left out, their lightmaps hold their own glow.
std::vector<Luxel> collect_luxels(const formats::Bsp& bsp);

// `count` of them, spread evenly by chance (all, where there are no more).
std::vector<Luxel> choose_luxels(std::vector<Luxel> luxels, size_t count, uint32_t seed);

} // namespace vkpt::tools
