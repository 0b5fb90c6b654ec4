// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/map_compiler/tracer.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <set>

namespace vkpt::tests {

using namespace formats;

namespace {

// The box's corner that first meets a plane with this normal.
glm::vec3 leading_corner(const TraceBox& box, const glm::vec3& normal)
{
    glm::vec3 corner;
    for (int axis = 0; axis < 3; axis++)
        corner[axis] = normal[axis] < 0 ? box.maxs[axis] : box.mins[axis];
    return corner;
}

void collect_brushes(const Bsp& bsp, int index, const TraceBox& swept, uint32_t mask, std::set<int>& result)
{
    if (index < 0) {
        const BspLeaf& leaf = bsp.leaves[size_t(-(index + 1))];
        if (leaf.contents & mask)
            for (uint32_t i = 0; i < leaf.leaf_brush_count; i++)
                result.insert(bsp.leaf_brushes[size_t(leaf.first_leaf_brush) + i]);
        return;
    }
    const BspNode& node = bsp.nodes[size_t(index)];
    const BspPlane& plane = bsp.planes[size_t(node.plane)];
    if (glm::dot(leading_corner(swept, -plane.normal), plane.normal) >= plane.dist)
        collect_brushes(bsp, node.children[0], swept, mask, result);
    if (glm::dot(leading_corner(swept, plane.normal), plane.normal) <= plane.dist)
        collect_brushes(bsp, node.children[1], swept, mask, result);
}

void clip_to_brush(
    const Bsp& bsp, const BspBrush& brush, const TraceBox& box, glm::vec3 from, glm::vec3 to, TraceResult& result)
{
    float enter = -1, leave = 1;
    glm::vec3 normal(0);
    bool starts_outside = false;
    for (int i = 0; i < brush.side_count; i++) {
        const BspPlane& plane = bsp.planes[bsp.brush_sides[size_t(brush.first_side + i)].plane];
        const float dist = plane.dist - glm::dot(leading_corner(box, plane.normal), plane.normal);
        const float a = glm::dot(from, plane.normal) - dist, b = glm::dot(to, plane.normal) - dist;
        starts_outside |= a > 0;
        if (a > 0 && b >= a)
            return;
        if (a <= 0 && b <= 0)
            continue;
        const float at = a / (a - b);
        if (a > b && at > enter) {
            enter = at;
            normal = plane.normal;
        } else if (a < b) {
            leave = std::min(leave, at);
        }
    }
    if (!starts_outside) {
        result.starts_solid = true;
        result.contents = brush.contents;
        result.fraction = 0;
    } else if (enter < leave && enter >= 0 && enter < result.fraction) {
        result.fraction = enter;
        result.normal = normal;
        result.contents = brush.contents;
    }
}

} // namespace

TraceResult trace_box(const Bsp& bsp, const TraceBox& box, glm::vec3 from, glm::vec3 to, uint32_t mask, int head_node)
{
    const TraceBox swept { glm::min(from, to) + box.mins - 1.0f, glm::max(from, to) + box.maxs + 1.0f };
    std::set<int> brushes;
    collect_brushes(bsp, head_node, swept, mask, brushes);
    TraceResult result;
    for (const int index : brushes)
        if (bsp.brushes[size_t(index)].contents & mask)
            clip_to_brush(bsp, bsp.brushes[size_t(index)], box, from, to, result);
    return result;
}

} // namespace vkpt::tests
