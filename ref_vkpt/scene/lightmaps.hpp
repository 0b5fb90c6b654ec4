// SPDX-License-Identifier: GPL-2.0-or-later
// A map's baked lightmaps as shaders read them (shaders/classic_light.comp).
#pragma once

#include "shaders/shared/scene.h"

#include <cstdint>
#include <vector>

namespace vkpt {

struct World;

struct Lightmaps {
    std::vector<shared::LightmapFace> faces; // one for each face of the map
    std::vector<uint32_t> luxels; // see LightmapFace::first; never empty
};

// Faces whose lightmaps lie outside of the map's data have none, nor have those that come when all faces together have
// had as many luxels as there are: each belongs to one face.
Lightmaps read_lightmaps(const World& world);

} // namespace vkpt
