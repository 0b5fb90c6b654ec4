// SPDX-License-Identifier: GPL-2.0-or-later
// Makes the tree that shaders/lib/trace_software.glsl walks.
//
// Node, 96 bytes: for each axis eight 8-bit low planes (8 bytes), then eight high planes (8 bytes); at byte 48 the
// frame that they count in, its corner (three floats, world space) and the distances between planes (10 bits an axis,
// see BVH_STEP_BITS); at byte 64 eight 32-bit child words (shaders/shared/trace.h). A child that is not there has
// inverted planes, and BVH_NO_CHILD in case a ray from very far away meets it all the same. As nothing depends on a
// frame of the whole tree, a ray goes from one tree to another without being prepared anew.
//
// Triangle, 48 bytes, in leaf order: its three corners (floats), id | mask << 24, eight free bytes.
//
// Why so: on two cores with AVX-512 through the Vulkan CPU driver, million rays a second per core for coherent camera
// rays / one diffuse bounce / shadow rays in a middle-sized map were: 3.1 / 1.0 / 1.5 for a plain binary tree, 9.1
// / 4.1 / 6.1 with four children and float boxes, 10 / 5.6 / 7.3 with eight, 14 / 6.5 / 9.1 with eight quantised ones,
// which halve the loads; the driver's own ray query reached 1.3 / .71 / 1.1. All planes of an axis are one texel of 16
// bytes, whose halves a ray's sign swaps, and the sizes are whole texels: read as such, nodes and triangles cost that
// driver half of what 64-bit loads do (docs/notes/cpu-driver.md).
#include "ref_vkpt/rays/bvh.hpp"

#include "ref_vkpt/rays/reinsertion.hpp"
#include "ref_vkpt/rays/wide_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

namespace vkpt {
namespace {

using namespace shared;

constexpr uint32_t max_triangles = 1u << 24;
// Areas of larger boxes and distances to them would not fit a float.
constexpr float max_coordinate = 1e15f;

static_assert(TRACE_STACK_BYTES_PER_LANE == TRACE_STACK_ENTRIES * 8);

void write_triangles(
    std::span<const BvhTriangle> triangles, std::span<const uint32_t> usable, const BinaryTree& tree, Bvh& bvh)
{
    bvh.triangle_count = uint32_t(tree.order.size());
    // One empty record even in an empty tree: its address must be one.
    bvh.triangles.resize(std::max<size_t>(tree.order.size(), 1) * bvh_triangle_words);
    for (size_t slot = 0; slot < tree.order.size(); slot++) {
        const BvhTriangle& triangle = triangles[usable[tree.order[slot]]];
        uint32_t* record = &bvh.triangles[slot * bvh_triangle_words];
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
    BinaryTree tree = quality == BvhQuality::best ? build_sah(boxes, BVH_MAX_LEAF_TRIANGLES)
                                                  : build_lbvh(boxes, BVH_MAX_LEAF_TRIANGLES);
    if (quality == BvhQuality::best)
        reinsert_subtrees(tree);
    const WideTree wide = make_wide(tree, boxes, BVH_MAX_LEAF_TRIANGLES, TRACE_STACK_ENTRIES);
    const float margin = box_margin(tree.nodes.empty() ? Box() : tree.nodes[0].box);
    Bvh bvh;
    bvh.max_depth = wide.max_depth;
    bvh.node_count = uint32_t(wide.nodes.size());
    bvh.nodes.resize(wide.nodes.size() * bvh_node_words);
    for (size_t i = 0; i < wide.nodes.size(); i++)
        write_node(margin, wide.nodes[i], &bvh.nodes[i * bvh_node_words]);
    write_triangles(triangles, usable, tree, bvh);
    return bvh;
}

uint32_t append_bvh(Bvh& bvh, const Bvh& other)
{
    const TreePlace place { bvh.node_count, uint32_t(bvh.triangles.size() / bvh_triangle_words) };
    const size_t first_word = bvh.nodes.size();
    bvh.nodes.insert(bvh.nodes.end(), other.nodes.begin(), other.nodes.end());
    place_nodes(std::span(bvh.nodes).subspan(first_word), place);
    bvh.triangles.insert(bvh.triangles.end(), other.triangles.begin(), other.triangles.end());
    bvh.triangle_count += other.triangle_count;
    bvh.node_count += other.node_count;
    bvh.max_depth = std::max(bvh.max_depth, other.max_depth);
    return place.first_node;
}

} // namespace vkpt
