// SPDX-License-Identifier: GPL-2.0-or-later
// Reads what the tree builders wrote, and checks what the traversal relies on.
#pragma once

#include "ref_vkpt/rays/bvh.hpp"
#include "shaders/shared/trace.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace vkpt::tests {

struct DecodedTriangle {
    glm::vec3 corners[3];
    uint32_t id_and_mask;
};
static_assert(sizeof(DecodedTriangle) <= shared::BVH_TRIANGLE_BYTES);
DecodedTriangle decode_triangle(const Bvh& bvh, uint32_t slot);

struct DecodedChild {
    double low[3], high[3];
    uint32_t word;
    bool exists() const { return word != shared::BVH_NO_CHILD; }
    bool is_leaf() const { return word & shared::BVH_LEAF; }
    uint32_t first() const { return word & shared::BVH_LEAF_FIRST_MASK; }
    uint32_t count() const { return ((word & shared::BVH_LEAF_COUNT_MASK) >> shared::BVH_LEAF_COUNT_SHIFT) + 1; }
};
DecodedChild decode_child(const Bvh& bvh, uint32_t node, uint32_t slot);

struct WorldBox {
    glm::dvec3 low { std::numeric_limits<double>::max() }, high { std::numeric_limits<double>::lowest() };
};

struct TreeCheck {
    const Bvh& bvh;
    std::vector<uint32_t> node_visits, triangle_visits;

    explicit TreeCheck(const Bvh& tree)
        : bvh(tree)
        , node_visits(tree.node_count)
        , triangle_visits(tree.triangle_count)
    {
    }
    // Checks that what lies below is inside the planes of each child; returns its bounds and the stack it needs.
    std::pair<WorldBox, uint32_t> check(uint32_t node, uint32_t depth);

private:
    WorldBox leaf_bounds(const DecodedChild& leaf);
    void expect_contained(const DecodedChild& child, const WorldBox& inside, uint32_t node, uint32_t slot) const;
};

} // namespace vkpt::tests
