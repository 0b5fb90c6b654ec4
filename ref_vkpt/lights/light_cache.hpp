// SPDX-License-Identifier: GPL-2.0-or-later
// Where the light cache keeps the light of the map's faces (docs/light-cache.md): squares on each face, aligned with
// its longest edge.
#pragma once

#include "ref_vkpt/lights/light_lists.hpp"
#include "shaders/shared/light_cache.h"

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace vkpt {

struct LightCacheLayout {
    float cell_size = 0; // units
    std::vector<shared::CacheFace> faces; // as the map's
    std::vector<shared::CacheFacePlane> planes;
    std::vector<shared::CacheCell> cells;
    std::vector<glm::vec2> corners;
    uint32_t value_count = 0;
};

inline constexpr float finest_cache_cell = 16; // units, as the classic lightmaps' texels
inline constexpr size_t max_cache_cells = 1u << 16; // cells grow until a map needs no more

// Faces of the world that bounce rays can end on and that a leaf names. Those that see lights of more than CACHE_LAYERS
// lightstyles have no cells, nor have those whose outline has no area. `emitters`: those that the lists were built
// with.
LightCacheLayout lay_out_light_cache(
    const formats::Bsp& bsp, const LightLists& lists, std::span<const shared::Emitter> emitters);

} // namespace vkpt
