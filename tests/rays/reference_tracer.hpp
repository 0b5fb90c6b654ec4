// SPDX-License-Identifier: GPL-2.0-or-later
// Ray tracing in double precision on the CPU, for comparison: shares no code with the backend it judges.
#pragma once

#include "ref_vkpt/rays/bvh.hpp"
#include "tests/rays/trace_rays.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace vkpt::tests {

// Where a ray crosses a triangle's plane.
struct PlaneCrossing {
    double t = 0;
    double u = 0, v = 0; // of the crossing, inside the triangle if u, v, 1 - u - v >= 0
    double slope = 0; // |cosine| between ray and normal
    double size = 0; // the triangle's shortest height
    bool front = false;
    bool exists = false; // not if the ray is parallel to the plane
    double edge_distance() const; // smallest weight of a corner; < 0 outside
};
PlaneCrossing cross_plane(const shared::TestRay& ray, const BvhTriangle& triangle);

struct ReferenceHit {
    int64_t triangle = -1; // index, not id
    PlaneCrossing crossing;
};

class ReferenceTracer {
public:
    explicit ReferenceTracer(std::span<const BvhTriangle> triangles);
    ReferenceHit trace(const shared::TestRay& ray, uint32_t ray_mask) const;
    // The same without a tree: every triangle is tried.
    ReferenceHit trace_slowly(const shared::TestRay& ray, uint32_t ray_mask) const;

private:
    struct Node {
        glm::dvec3 low, high;
        uint32_t first = 0, count = 0;
        uint32_t right = 0; // of an inner node; the left child is the next one
    };
    void build(uint32_t first, uint32_t count);
    void try_triangle(const shared::TestRay& ray, uint32_t ray_mask, uint32_t triangle, ReferenceHit& best) const;

    std::span<const BvhTriangle> triangles_;
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace vkpt::tests
