// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/cluster_finder.hpp"

#include "ref_vkpt/lights/spot_cone.hpp"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

namespace vkpt {

namespace {

using formats::Bsp;

// A shape this near to a plane counts as on both of its sides, units. Map compilers round corners to about as much.
constexpr float plane_tolerance = 0.05f;
constexpr size_t max_corners = 24;
constexpr uint64_t steps_of_polygon = 16; // what a polygon takes at a node, measured in balls

struct Polygon {
    std::array<glm::vec3, max_corners> corners;
    size_t count = 0;
};

struct Range {
    float lowest, highest;
};

Range measure_heights(const Polygon& polygon, const formats::BspPlane& plane, std::array<float, max_corners>& heights)
{
    Range range { 1e30f, -1e30f };
    for (size_t i = 0; i < polygon.count; i++) {
        heights[i] = glm::dot(plane.normal, polygon.corners[i]) - plane.dist;
        range.lowest = std::min(range.lowest, heights[i]);
        range.highest = std::max(range.highest, heights[i]);
    }
    return range;
}

// Keeps what lies above -plane_tolerance (`sign` 1) or below plane_tolerance (-1). A polygon that would get too many
// corners is kept whole: it then touches more, never less.
Polygon clip(const Polygon& polygon, const std::array<float, max_corners>& heights, float sign)
{
    Polygon kept;
    for (size_t i = 0; i < polygon.count; i++) {
        const size_t next = i + 1 < polygon.count ? i + 1 : 0;
        const float here = heights[i] * sign + plane_tolerance, there = heights[next] * sign + plane_tolerance;
        if (kept.count + 2 > max_corners)
            return polygon;
        if (here >= 0)
            kept.corners[kept.count++] = polygon.corners[i];
        if ((here >= 0) != (there >= 0))
            kept.corners[kept.count++]
                = polygon.corners[i] + (polygon.corners[next] - polygon.corners[i]) * (here / (here - there));
    }
    return kept;
}

// Returns how many nodes and leaves it has visited.
template <class VisitLeaf> uint64_t walk_polygon(const Bsp& bsp, const Polygon& polygon, VisitLeaf visit)
{
    struct Pending {
        int32_t child;
        Polygon polygon;
    };
    std::vector<Pending> pending { { find_world_root(bsp), polygon } };
    std::array<float, max_corners> heights;
    uint64_t visited = 0;
    while (!pending.empty()) {
        const Pending here = pending.back();
        pending.pop_back();
        visited++;
        if (here.child < 0) {
            visit(bsp.leaves[size_t(-1 - here.child)]);
            continue;
        }
        const formats::BspNode& node = bsp.nodes[size_t(here.child)];
        const Range range = measure_heights(here.polygon, bsp.planes[size_t(node.plane)], heights);
        const bool above = range.highest > -plane_tolerance, below = range.lowest < plane_tolerance;
        const bool both = above && below;
        if (above)
            pending.push_back({ node.children[0], both ? clip(here.polygon, heights, 1) : here.polygon });
        if (below)
            pending.push_back({ node.children[1], both ? clip(here.polygon, heights, -1) : here.polygon });
    }
    return visited;
}

// `visit` returns false to stop. Returns how many nodes and leaves it has visited.
template <class VisitLeaf> uint64_t walk_ball(const Bsp& bsp, glm::vec3 centre, float radius, VisitLeaf visit)
{
    std::vector<int32_t> pending { find_world_root(bsp) };
    uint64_t visited = 0;
    while (!pending.empty()) {
        const int32_t child = pending.back();
        pending.pop_back();
        visited++;
        if (child < 0) {
            if (!visit(bsp.leaves[size_t(-1 - child)]))
                break;
            continue;
        }
        const formats::BspNode& node = bsp.nodes[size_t(child)];
        const formats::BspPlane& plane = bsp.planes[size_t(node.plane)];
        const float height = glm::dot(plane.normal, centre) - plane.dist;
        if (height > -radius)
            pending.push_back(node.children[0]);
        if (height < radius)
            pending.push_back(node.children[1]);
    }
    return visited;
}

Polygon lift_triangle(const shared::Emitter& emitter, float lift)
{
    const glm::vec3 across = glm::cross(emitter.p1 - emitter.p0, emitter.p2 - emitter.p0);
    const float size = glm::length(across);
    const glm::vec3 offset = size > 0 ? across * (lift / size) : glm::vec3(0);
    Polygon polygon;
    polygon.corners[0] = emitter.p0 + offset;
    polygon.corners[1] = emitter.p1 + offset;
    polygon.corners[2] = emitter.p2 + offset;
    polygon.count = 3;
    return polygon;
}

} // namespace

int32_t find_world_root(const Bsp& bsp)
{
    const int32_t root = bsp.models.empty() ? 0 : bsp.models[0].head_node;
    return bsp.nodes.empty() && root >= 0 ? -1 : root;
}

std::vector<int> find_touched_clusters(const Bsp& bsp, const shared::Emitter& emitter, float lift, uint64_t& steps)
{
    std::vector<int> clusters;
    const auto collect = [&](const formats::BspLeaf& leaf) {
        if (leaf.cluster >= 0 && leaf.cluster < bsp.cluster_count)
            clusters.push_back(leaf.cluster);
        return true;
    };
    if (is_sphere(emitter))
        steps += walk_ball(bsp, emitter.p0, std::max(emitter.p1.x, plane_tolerance), collect);
    else
        steps += steps_of_polygon * walk_polygon(bsp, lift_triangle(emitter, lift), collect);
    std::sort(clusters.begin(), clusters.end());
    clusters.erase(std::unique(clusters.begin(), clusters.end()), clusters.end());
    return clusters;
}

bool touches_solid(const Bsp& bsp, glm::vec3 centre, float radius, uint64_t& steps)
{
    bool solid = false;
    steps += walk_ball(bsp, centre, radius, [&](const formats::BspLeaf& leaf) {
        solid = leaf.contents & formats::CONTENTS_SOLID;
        return !solid;
    });
    return solid;
}

} // namespace vkpt
