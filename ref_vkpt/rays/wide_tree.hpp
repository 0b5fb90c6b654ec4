// SPDX-License-Identifier: GPL-2.0-or-later
// From binary trees to the 8-wide nodes that shaders/lib/trace_software.glsl walks (layout: see bvh.cpp): which
// children a node has and how their boxes are written.
#pragma once

#include "ref_vkpt/rays/binary_tree.hpp"
#include "ref_vkpt/rays/float4.hpp"
#include "shaders/shared/trace.h"

#include <array>
#include <cstdint>

namespace vkpt {

inline constexpr uint32_t bvh_node_words = shared::BVH_NODE_BYTES / 4;
inline constexpr uint32_t bvh_triangle_words = shared::BVH_TRIANGLE_BYTES / 4;

// How much larger boxes are written than they are, in units, on every side, given what bounds the tree. It must cover
// the rounding in the shader's (plane - origin) * inverse, which grows with the ray's distance from the box: about 3e-7
// of it. 1/32 unit does for 100,000 units; trees with larger coordinates get as much more.
float box_margin(const Box& bounds);

struct WideNode {
    std::array<Box, shared::BVH_WIDTH> boxes;
    std::array<uint32_t, shared::BVH_WIDTH>
        words; // see shaders/shared/trace.h; a leaf's slots are places in BinaryTree::order
    uint32_t child_count = 0;
};

struct WideTree {
    std::vector<WideNode> nodes; // at least one; every node stands before its children
    uint32_t max_depth = 1; // in nodes
    uint32_t stack_need = 0; // entries that a ray can need
};

// The most boxes for which make_wide() can keep to a budget of stack entries, whatever the boxes are.
uint32_t max_boxes_within(uint32_t stack_budget, uint32_t max_leaf);

// No ray needs more than `stack_budget` entries for the result, given no more boxes than max_boxes_within(stack_budget,
// max_leaf): where `tree`, made with the same `max_leaf`, is too deep, its parts are replaced by balanced ones.
WideTree make_wide(BinaryTree& tree, std::span<const Box> boxes, uint32_t max_leaf, uint32_t stack_budget);

// Writes one node, bvh_node_words long.
void write_node(float margin, const Box4* boxes, const uint32_t* words, uint32_t child_count, uint32_t* node);
void write_node(float margin, const WideNode& wide, uint32_t* node);

// Where a tree stands in arrays that hold several: indices of its first node and of its first triangle's slot.
struct TreePlace {
    uint32_t first_node = 0, first_slot = 0;

    // A child's word, which counted from the tree's own first node and slot.
    uint32_t placed(uint32_t word) const
    {
        if (word == shared::BVH_NO_CHILD)
            return word;
        return word + (word & shared::BVH_LEAF ? first_slot : first_node);
    }
};

// Makes the words of written nodes count as `place` says.
void place_nodes(std::span<uint32_t> nodes, const TreePlace& place);

} // namespace vkpt
