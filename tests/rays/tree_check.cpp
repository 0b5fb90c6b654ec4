// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/rays/tree_check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {

using namespace shared;

DecodedTriangle decode_triangle(const Bvh& bvh, uint32_t slot)
{
    DecodedTriangle triangle;
    std::memcpy(static_cast<void*>(&triangle), &bvh.triangles[slot * size_t(BVH_TRIANGLE_BYTES) / 4], sizeof triangle);
    return triangle;
}

DecodedChild decode_child(const Bvh& bvh, uint32_t node, uint32_t slot)
{
    const auto* bytes = reinterpret_cast<const std::byte*>(bvh.nodes.data()) + node * size_t(BVH_NODE_BYTES);
    DecodedChild child;
    float corner[3];
    uint32_t steps;
    std::memcpy(corner, bytes + BVH_FRAME_OFFSET, sizeof corner);
    std::memcpy(&steps, bytes + BVH_FRAME_OFFSET + sizeof corner, sizeof steps);
    for (uint32_t axis = 0; axis < 3; axis++) {
        const uint32_t code = steps >> (axis * BVH_STEP_BITS) & ((1u << BVH_STEP_BITS) - 1);
        const double step = double(std::bit_cast<float>(code << BVH_STEP_SHIFT)), from = double(corner[axis]);
        child.low[axis] = from + step * std::to_integer<int>(bytes[axis * 16 + slot]);
        child.high[axis] = from + step * std::to_integer<int>(bytes[axis * 16 + 8 + slot]);
    }
    std::memcpy(&child.word, bytes + BVH_CHILD_WORDS_OFFSET + slot * 4, 4);
    return child;
}

std::pair<WorldBox, uint32_t> TreeCheck::check(uint32_t node, uint32_t depth)
{
    WorldBox bounds;
    uint32_t children = 0, need = 0;
    if (node >= bvh.node_count || depth > bvh.max_depth) {
        ADD_FAILURE() << "node " << node << " of " << bvh.node_count << " at depth " << depth;
        return { bounds, 0 };
    }
    node_visits[node]++;
    for (uint32_t slot = 0; slot < BVH_WIDTH; slot++) {
        DecodedChild child = decode_child(bvh, node, slot);
        if (!child.exists()) {
            for (int axis = 0; axis < 3; axis++)
                EXPECT_GT(child.low[axis], child.high[axis]);
            continue;
        }
        children++;
        auto [inside, child_need] = child.is_leaf() ? std::pair(leaf_bounds(child), 0u) : check(child.word, depth + 1);
        need = std::max(need, child_need);
        expect_contained(child, inside, node, slot);
        bounds.low = glm::min(bounds.low, inside.low);
        bounds.high = glm::max(bounds.high, inside.high);
    }
    return { bounds, need + (children ? children - 1 : 0) };
}

WorldBox TreeCheck::leaf_bounds(const DecodedChild& leaf)
{
    WorldBox bounds;
    EXPECT_LE(leaf.count(), BVH_MAX_LEAF_TRIANGLES);
    for (uint32_t slot = leaf.first(); slot < leaf.first() + leaf.count(); slot++) {
        if (slot >= bvh.triangle_count) {
            ADD_FAILURE() << "triangle " << slot << " of " << bvh.triangle_count;
            break;
        }
        triangle_visits[slot]++;
        DecodedTriangle triangle = decode_triangle(bvh, slot);
        for (glm::dvec3 q : triangle.corners) {
            bounds.low = glm::min(bounds.low, q);
            bounds.high = glm::max(bounds.high, q);
        }
    }
    return bounds;
}

// With most of the least margin to spare: the shader needs it for its own rounding.
void TreeCheck::expect_contained(const DecodedChild& child, const WorldBox& inside, uint32_t node, uint32_t slot) const
{
    constexpr double spare = 0.75 / 32;
    for (int axis = 0; axis < 3; axis++) {
        EXPECT_LE(child.low[axis] + spare, inside.low[axis]) << "node " << node << " child " << slot;
        EXPECT_GE(child.high[axis] - spare, inside.high[axis]) << "node " << node << " child " << slot;
    }
}

} // namespace vkpt::tests
