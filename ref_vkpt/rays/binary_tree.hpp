// SPDX-License-Identifier: GPL-2.0-or-later
// Binary trees over boxes, which bvh.cpp makes wide. Three ways to build one: slow and good, quick, and sure to be
// shallow.
#pragma once

#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

namespace vkpt {

struct Box {
    glm::vec3 low { std::numeric_limits<float>::max() };
    glm::vec3 high { std::numeric_limits<float>::lowest() };

    void add(glm::vec3 p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    void add(const Box& box)
    {
        low = glm::min(low, box.low);
        high = glm::max(high, box.high);
    }
    // Half the surface; of a box without points it is meaningless.
    float half_area() const
    {
        glm::vec3 d = high - low;
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }
    glm::vec3 centre() const { return (low + high) * 0.5f; }
};

struct BinaryNode {
    Box box;
    uint32_t first = 0, count = 0; // its boxes: order[first .. + count), inner nodes too
    uint32_t left = 0, right = 0; // nodes; 0 in leaves, as the root is nobody's child
    bool is_leaf() const { return left == 0; }
};

struct BinaryTree {
    std::vector<BinaryNode> nodes; // [0] is the root; empty without boxes
    std::vector<uint32_t> order; // indices of boxes
};

// Leaves hold up to `max_leaf` boxes.
// Surface-area heuristic over binned centres (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies",
// 2007).
BinaryTree build_sah(std::span<const Box> boxes, uint32_t max_leaf);
// Order along the Z curve, split where the codes' highest differing bit flips (Lauterbach et al., "Fast BVH
// Construction on GPUs", 2009).
BinaryTree build_lbvh(std::span<const Box> boxes, uint32_t max_leaf);
// Replaces what stands below `node` by halves of equal count, whatever the boxes are.
void rebuild_balanced(BinaryTree& tree, uint32_t node, std::span<const Box> boxes, uint32_t max_leaf);

} // namespace vkpt
