// SPDX-License-Identifier: GPL-2.0-or-later
// Makes the tree that shaders/lib/trace_software.glsl walks.
//
// Node, 128 bytes: for each axis eight 16-bit low planes (16 bytes), then eight 16-bit high planes (16 bytes); at byte
// 96 eight 32-bit child words (shaders/shared/trace.h). Planes are positions on one grid for the whole tree. A child
// that is not there has inverted planes, and BVH_NO_CHILD in case a ray from very far away meets it all the same.
// Triangle, 40 bytes, in leaf order: its three corners (floats), id | mask << 24.
//
// Why so: on two cores with AVX-512 through the Vulkan CPU driver, million rays a second per core for coherent camera
// rays / one diffuse bounce / shadow rays in a middle-sized map were: 3.1 / 1.0 / 1.5 for a plain binary tree, 9.1
// / 4.1 / 6.1 with four children and float boxes, 10 / 5.6 / 7.3 with eight, 14 / 6.5 / 9.1 with eight quantised ones,
// which halve the loads; the driver's own ray query reached 1.3 / .71 / 1.1. Low and high planes stand apart so that a
// ray's sign on an axis picks the near and far ones by address; the sizes let all of it be read by 64-bit loads.
#include "ref_vkpt/trace/bvh.hpp"

#include "ref_vkpt/trace/binary_tree.hpp"
#include "shaders/shared/trace.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace vkpt {
namespace {

using namespace shared;

constexpr uint32_t node_words = BVH_NODE_BYTES / 4, triangle_words = BVH_TRIANGLE_BYTES / 4;
constexpr uint32_t max_triangles = 1u << 24;
// Areas of larger boxes and distances to them would not fit a float.
constexpr float max_coordinate = 1e15f;

// 16-bit positions in the root's box, on every axis with a margin.
struct Grid {
    glm::vec3 origin { 0 };
    glm::vec3 scale { 1 };

    // The margin of one cell to either side must cover the rounding in the shader's (plane - origin) * inverse, which
    // grows with the ray's distance from the grid: about 3e-7 of it. With cells of at least 1/32 unit it does for
    // 100,000 units.
    static constexpr float min_extent = 2048.0f;

    explicit Grid(const Box& bounds)
    {
        constexpr float cells = 65500.0f, cells_before = 16.0f;
        glm::vec3 extent = glm::max(bounds.high - bounds.low, glm::vec3(min_extent));
        scale = cells / extent;
        origin = bounds.low - cells_before / scale;
    }
    glm::uvec3 low_planes(const Box& box) const { return glm::uvec3((box.low - origin) * scale) - 1u; }
    glm::uvec3 high_planes(const Box& box) const
    {
        return glm::min(glm::uvec3((box.high - origin) * scale) + 2u, 65535u);
    }
};

// Stack entries that a balanced tree over `count` triangles can need: every wide level leaves seven children behind and
// an eighth of the triangles before it.
uint32_t balanced_stack_need(uint32_t count)
{
    uint32_t leaves = (count + BVH_MAX_LEAF_TRIANGLES - 1) / BVH_MAX_LEAF_TRIANGLES;
    uint32_t binary_levels = leaves > 1 ? uint32_t(std::bit_width(leaves - 1)) : 0;
    return (binary_levels + 2) / 3 * (BVH_WIDTH - 1);
}
static_assert(
    (22 + 2) / 3 * (BVH_WIDTH - 1) <= TRACE_STACK_ENTRIES, "max_triangles in leaves of four: 22 binary levels");
static_assert(TRACE_STACK_BYTES_PER_LANE == TRACE_STACK_ENTRIES * 8);

struct Children {
    std::array<uint32_t, BVH_WIDTH> nodes {};
    uint32_t count = 0;
};

// Turns a binary tree into wide nodes, written in depth-first order.
class WideWriter {
public:
    WideWriter(BinaryTree& tree, std::span<const Box> boxes, Bvh& bvh)
        : tree_(tree)
        , boxes_(boxes)
        , grid_(tree.nodes.empty() ? Box { glm::vec3(0), glm::vec3(0) } : tree.nodes[0].box)
        , bvh_(bvh)
    {
        bvh_.grid_origin = grid_.origin;
        bvh_.grid_scale = grid_.scale;
    }

    void write()
    {
        bvh_.max_depth = 1;
        if (tree_.nodes.empty())
            add_node();
        else
            write_node(0, TRACE_STACK_ENTRIES, 1, false);
        bvh_.node_count = uint32_t(bvh_.nodes.size()) / node_words;
    }

private:
    // `stack_left`: entries that are free when a ray enters the node. `balanced`: the node is from rebuild_balanced().
    uint32_t write_node(uint32_t node, uint32_t stack_left, uint32_t depth, bool balanced)
    {
        Children children = balanced ? open_children(node, &count_of) : open_children(node, &area_of);
        if (!balanced && !fits_stack(children, stack_left)) {
            balanced = true;
            rebuild_balanced(tree_, node, boxes_, BVH_MAX_LEAF_TRIANGLES);
            children = open_children(node, &count_of);
        }
        bvh_.max_depth = std::max(bvh_.max_depth, depth);
        uint32_t index = add_node();
        for (uint32_t slot = 0; slot < children.count; slot++) {
            BinaryNode child = tree_.nodes[children.nodes[slot]]; // a copy: writing children may move the nodes
            uint32_t word = child.is_leaf()
                ? BVH_LEAF | (child.count - 1) << BVH_LEAF_COUNT_SHIFT | child.first
                : write_node(children.nodes[slot], stack_left - (children.count - 1), depth + 1, balanced);
            write_child(index, slot, child.box, word);
        }
        return index;
    }

    static float area_of(const BinaryNode& node) { return node.box.half_area(); }
    static float count_of(const BinaryNode& node) { return float(node.count); }

    // Replaces the inner node of the highest `weight` by its two children until eight are there. By area, these are the
    // nodes that most rays would have to open; by count, all of one level come before those of the next.
    Children open_children(uint32_t node, float (*weight)(const BinaryNode&)) const
    {
        Children children;
        children.nodes[children.count++] = node;
        while (children.count < BVH_WIDTH) {
            uint32_t best = BVH_WIDTH;
            float best_weight = -1.0f;
            for (uint32_t i = 0; i < children.count; i++) {
                const BinaryNode& child = tree_.nodes[children.nodes[i]];
                if (!child.is_leaf() && weight(child) > best_weight) {
                    best = i;
                    best_weight = weight(child);
                }
            }
            if (best == BVH_WIDTH)
                break;
            const BinaryNode& opened = tree_.nodes[children.nodes[best]];
            children.nodes[best] = opened.left;
            children.nodes[children.count++] = opened.right;
        }
        return children;
    }

    // Whether below each child at least a balanced tree can still be walked. Holds for the root by max_triangles, so
    // that wherever it fails first, a balanced tree can stand in.
    bool fits_stack(const Children& children, uint32_t stack_left) const
    {
        return std::all_of(children.nodes.begin(), children.nodes.begin() + children.count, [&](uint32_t node) {
            return balanced_stack_need(tree_.nodes[node].count) + children.count - 1 <= stack_left;
        });
    }

    uint32_t add_node()
    {
        static const std::array<uint32_t, node_words> empty = [] {
            std::array<uint32_t, node_words> words {};
            for (uint32_t axis = 0; axis < 3; axis++)
                std::fill_n(words.begin() + axis * 8, 4, 0xffffffffu); // low planes; the high ones stay 0
            std::fill_n(words.begin() + BVH_CHILD_WORDS_OFFSET / 4, BVH_WIDTH, BVH_NO_CHILD);
            return words;
        }();
        uint32_t index = uint32_t(bvh_.nodes.size()) / node_words;
        bvh_.nodes.insert(bvh_.nodes.end(), empty.begin(), empty.end());
        return index;
    }

    void write_child(uint32_t node, uint32_t slot, const Box& box, uint32_t word)
    {
        auto* bytes = reinterpret_cast<std::byte*>(&bvh_.nodes[size_t(node) * node_words]);
        glm::uvec3 low = grid_.low_planes(box), high = grid_.high_planes(box);
        for (int axis = 0; axis < 3; axis++) {
            uint16_t planes[2] = { uint16_t(low[axis]), uint16_t(high[axis]) };
            for (int side = 0; side < 2; side++)
                std::memcpy(bytes + axis * 32 + side * 16 + slot * 2, &planes[side], 2);
        }
        std::memcpy(bytes + BVH_CHILD_WORDS_OFFSET + slot * 4, &word, 4);
    }

    BinaryTree& tree_;
    std::span<const Box> boxes_;
    Grid grid_;
    Bvh& bvh_;
};

void write_triangles(
    std::span<const BvhTriangle> triangles, std::span<const uint32_t> usable, const BinaryTree& tree, Bvh& bvh)
{
    bvh.triangle_count = uint32_t(tree.order.size());
    // One empty record even in an empty tree: its address must be one.
    bvh.triangles.resize(std::max<size_t>(tree.order.size(), 1) * triangle_words);
    for (size_t slot = 0; slot < tree.order.size(); slot++) {
        const BvhTriangle& triangle = triangles[usable[tree.order[slot]]];
        uint32_t* record = &bvh.triangles[slot * triangle_words];
        static_assert(sizeof triangle.positions == 36);
        std::memcpy(record, triangle.positions, sizeof triangle.positions);
        record[9] = triangle.id | triangle.mask << BVH_RAY_MASK_SHIFT;
    }
}

} // namespace

bool can_be_met(const BvhTriangle& triangle)
{
    for (glm::vec3 p : triangle.positions)
        for (int axis = 0; axis < 3; axis++)
            if (!(std::abs(p[axis]) <= max_coordinate)) // NaN as well
                return false;
    glm::dvec3 corner = triangle.positions[0];
    glm::dvec3 normal
        = glm::cross(glm::dvec3(triangle.positions[1]) - corner, glm::dvec3(triangle.positions[2]) - corner);
    return normal != glm::dvec3(0.0) && triangle.id <= BVH_ID_MASK;
}

Bvh build_bvh(std::span<const BvhTriangle> triangles, BvhQuality quality)
{
    std::vector<uint32_t> usable;
    std::vector<Box> boxes;
    usable.reserve(triangles.size());
    boxes.reserve(triangles.size());
    for (size_t i = 0; i < triangles.size() && usable.size() < max_triangles; i++) {
        if (!can_be_met(triangles[i]))
            continue;
        Box& box = boxes.emplace_back();
        for (glm::vec3 p : triangles[i].positions)
            box.add(p);
        usable.push_back(uint32_t(i));
    }
    BinaryTree tree = quality == BvhQuality::best ? build_by_area(boxes, BVH_MAX_LEAF_TRIANGLES)
                                                  : build_by_morton(boxes, BVH_MAX_LEAF_TRIANGLES);
    Bvh bvh;
    bvh.nodes.reserve(boxes.size() / 4 * node_words + node_words);
    WideWriter(tree, boxes, bvh).write();
    write_triangles(triangles, usable, tree, bvh);
    return bvh;
}

} // namespace vkpt
