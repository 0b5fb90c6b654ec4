// SPDX-License-Identifier: GPL-2.0-or-later
// The software backend's acceleration structure: an 8-wide BVH with quantised boxes, for
// shaders/lib/trace_software.glsl.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace vkpt {

struct BvhTriangle {
    glm::vec3 positions[3];
    uint32_t id = 0; // what a hit reports, below 2^24
    uint32_t mask = 0; // MASK_* of shaders/shared/scene.h, the low 8 bits
};

enum class BvhQuality {
    best, // built once per map: binned surface-area heuristic over many bins
    fast, // built every frame for what moves
};

struct Bvh {
    std::vector<uint32_t> nodes; // layout: see bvh.cpp
    std::vector<uint32_t> triangles; // in leaf order, layout: see bvh.cpp
    uint32_t triangle_count = 0;
    uint32_t node_count = 0;
    uint32_t max_depth = 0; // of the wide tree, in nodes
};

// Whether a ray can meet it: false for degenerate, infinite and NaN triangles, corners beyond 1e15 and ids of 2^24 and
// more.
bool can_be_met(const BvhTriangle& triangle);

// Never fails: degenerate, infinite and NaN triangles are left out, as are corners beyond 1e15, ids of 2^24 and more
// and triangles after the first 2^24 usable ones; compare triangle_count where that matters. No triangle gives a valid,
// empty tree. No tree needs more than TRACE_STACK_ENTRIES (shaders/shared/trace.h) to walk.
Bvh build_bvh(std::span<const BvhTriangle> triangles, BvhQuality quality);

// Adds another tree to the arrays of nodes and triangles, and returns its root.
uint32_t append_bvh(Bvh& bvh, const Bvh& other);

} // namespace vkpt
