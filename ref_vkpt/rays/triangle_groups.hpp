// SPDX-License-Identifier: GPL-2.0-or-later
// Prepares triangles for the driver's acceleration structures, which know ray masks only per instance and opacity only
// per geometry: one group for each combination. CPU side.
#pragma once

#include "shaders/shared/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

struct TriangleGroup {
    uint32_t mask = 0; // MASK_* of shaders/shared/scene.h
    bool has_holes = false; // some texture's alpha decides
    uint32_t first = 0, count = 0;
};

struct GroupedTriangles {
    std::vector<glm::vec3> corners; // three per triangle
    std::vector<uint32_t> ids; // one per triangle: what a hit reports
    std::vector<TriangleGroup> groups; // none of them empty
};

// Within a group. Mesa's CPU driver halves a structure's triangles by their index, whatever they look like: in an order
// that makes these halves compact its rays are 2 to 3 times as fast. Other drivers do not care.
enum class TriangleOrder {
    as_given,
    halves_quick, // cut across the longest axis: for what moves
    halves_best, // cut along the axis of the lowest surface-area cost: once per map
};

struct TriangleSource {
    std::span<const shared::Triangle> triangles;
    std::span<const uint32_t> masks; // per triangle
    std::span<const uint8_t> has_holes; // per triangle, 1: its texture's alpha decides
    uint32_t first_id = 0; // ids ascend from here
};

// Leaves out what build_bvh leaves out.
GroupedTriangles group_triangles(const TriangleSource& source, TriangleOrder order);

} // namespace vkpt
