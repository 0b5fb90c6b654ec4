// SPDX-License-Identifier: GPL-2.0-or-later
// Triangle sets and rays for the tracing tests and the bench.
#pragma once

#include "ref_vkpt/rays/bvh.hpp"
#include "tests/rays/trace_rays.h"

#include <cstdint>
#include <filesystem>
#include <random>
#include <span>
#include <vector>

namespace vkpt::tests {

using Random = std::mt19937;

float uniform(Random& random, float low, float high);
glm::vec3 random_direction(Random& random); // unit

// `count` triangles of edges up to `size` units, in +-2048 units, masks 0xff, ids ascending from `first_id`.
std::vector<BvhTriangle> random_triangles(Random& random, size_t count, float size, uint32_t first_id = 0);
// A closed, axis-parallel room of +-`half` units around the origin, every wall cut into cells x cells squares of two
// triangles.
std::vector<BvhTriangle> room(float half, int cells, uint32_t first_id = 0);
// Rays between random points of +-`half` units, a tenth of them parallel to an axis; half of them segments, half
// unbounded.
std::vector<shared::TestRay> random_rays(Random& random, size_t count, float half);
struct MapScene {
    std::vector<BvhTriangle> triangles; // the world's faces but those not drawn and the sky
    std::vector<uint32_t> lights; // indices of those that emit light
    glm::vec3 eye { 0 }; // at the first player start
    float yaw = 0; // degrees
};
// Throws formats::FormatError.
MapScene load_map(const std::filesystem::path& bsp);

} // namespace vkpt::tests
