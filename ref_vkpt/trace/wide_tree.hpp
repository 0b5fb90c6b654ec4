// SPDX-License-Identifier: GPL-2.0-or-later
// From binary trees to the 8-wide nodes that shaders/lib/trace_software.glsl walks (layout: see bvh.cpp): which
// children a node has, on what grid their boxes lie, how they are written.
#pragma once

#include "ref_vkpt/trace/binary_tree.hpp"
#include "ref_vkpt/trace/float4.hpp"
#include "shaders/shared/trace.h"

#include <array>

namespace vkpt {

inline constexpr uint32_t bvh_node_words = shared::BVH_NODE_BYTES / 4;
inline constexpr uint32_t bvh_triangle_words = shared::BVH_TRIANGLE_BYTES / 4;

// 16-bit positions in a box that holds everything, on every axis with a margin: quantised = (world - origin) * scale.
struct Grid {
    glm::vec3 origin { 0 };
    glm::vec3 scale { 1 };

    // The margin of one cell to either side must cover the rounding in the shader's (plane - origin) * inverse, which
    // grows with the ray's distance from the grid: about 3e-7 of it. With cells of at least 1/32 unit it does for
    // 100,000 units.
    static constexpr float min_extent = 2048.0f;

    Grid() = default;
    // Of a box without points: one that serves an empty tree.
    explicit Grid(const Box& bounds);
};

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

// Writes one node, bvh_node_words long. Boxes that reach out of the grid are cut off at it.
void write_node(const Grid& grid, const Box4* boxes, const uint32_t* words, uint32_t child_count, uint32_t* node);
void write_node(const Grid& grid, const WideNode& wide, uint32_t* node);

} // namespace vkpt
