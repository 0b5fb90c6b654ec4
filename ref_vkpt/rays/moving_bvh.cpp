// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/rays/moving_bvh.hpp"

#include "ref_vkpt/rays/reinsertion.hpp"

#include <algorithm>
#include <cassert>

namespace vkpt {

using namespace shared;

namespace {

// 17 binary levels over leaves of four, 12 over single meshes; three to a wide level, which takes seven entries.
static_assert((17 - 2 + 2) / 3 * (BVH_WIDTH - 1) <= mesh_stack_budget);
static_assert((12 + 2) / 3 * (BVH_WIDTH - 1) + mesh_stack_budget <= TRACE_STACK_ENTRIES);
static_assert(max_mesh_triangles == 1u << 17 && BVH_MAX_LEAF_TRIANGLES == 4 && max_moving_meshes == 1u << 12);

bool is_leaf(uint32_t word) { return (word & BVH_LEAF) != 0; }

Box4 leaf_box(uint32_t word, std::span<const uint32_t> corners, const Float4* points)
{
    const uint32_t first = (word & BVH_LEAF_FIRST_MASK) * 3;
    const uint32_t count = (((word & BVH_LEAF_COUNT_MASK) >> BVH_LEAF_COUNT_SHIFT) + 1) * 3;
    Box4 box;
    for (uint32_t i = first; i < first + count; i++)
        box.add(points[corners[i]]);
    return box;
}

} // namespace

MeshTree build_mesh_tree(std::span<const Box> boxes)
{
    assert(boxes.size() <= max_mesh_triangles);
    BinaryTree binary = build_sah(boxes, BVH_MAX_LEAF_TRIANGLES);
    reinsert_subtrees(binary);
    const WideTree wide = make_wide(binary, boxes, BVH_MAX_LEAF_TRIANGLES, mesh_stack_budget);
    MeshTree tree;
    tree.node_count = uint32_t(wide.nodes.size());
    tree.stack_need = wide.stack_need;
    tree.words.reserve(wide.nodes.size() * BVH_WIDTH);
    for (const WideNode& node : wide.nodes)
        for (uint32_t slot = 0; slot < BVH_WIDTH; slot++)
            tree.words.push_back(slot < node.child_count ? node.words[slot] : BVH_NO_CHILD);
    tree.order = std::move(binary.order);
    return tree;
}

Box refit(const MeshTree& tree, std::span<const uint32_t> corners, const Float4* points, float margin,
    const TreePlace& place, uint32_t* nodes, std::vector<Box4>& node_boxes)
{
    node_boxes.resize(std::max<size_t>(node_boxes.size(), tree.node_count));
    for (uint32_t node = tree.node_count; node-- > 0;) { // children before their parents
        const uint32_t* words = &tree.words[size_t(node) * BVH_WIDTH];
        Box4 boxes[BVH_WIDTH];
        uint32_t placed_words[BVH_WIDTH];
        uint32_t count = 0;
        Box4 all;
        for (; count < BVH_WIDTH && words[count] != BVH_NO_CHILD; count++) {
            const uint32_t word = words[count];
            boxes[count] = is_leaf(word) ? leaf_box(word, corners, points) : node_boxes[word];
            placed_words[count] = place.placed(word);
            all.add(boxes[count]);
        }
        write_node(margin, boxes, placed_words, count, nodes + size_t(node) * bvh_node_words);
        node_boxes[node] = all;
    }
    return tree.node_count > 0 ? node_boxes[0].to_box() : Box();
}

void write_mesh(const WideTree& tree, float margin, const TreePlace& place, uint32_t* nodes)
{
    for (size_t i = 0; i < tree.nodes.size(); i++) {
        WideNode node = tree.nodes[i];
        for (uint32_t slot = 0; slot < node.child_count; slot++)
            node.words[slot] = place.placed(node.words[slot]);
        write_node(margin, node, nodes + i * bvh_node_words);
    }
}

void write_tlas(std::span<const MovingMesh> meshes, float margin, uint32_t first_node, uint32_t* nodes)
{
    assert(meshes.size() <= max_moving_meshes);
    std::vector<Box> boxes;
    uint32_t mesh_need = 0;
    for (const MovingMesh& mesh : meshes) {
        boxes.push_back(mesh.box);
        mesh_need = std::max(mesh_need, mesh.stack_need);
    }
    BinaryTree binary = build_sah(boxes, 1);
    WideTree wide = make_wide(binary, boxes, 1, TRACE_STACK_ENTRIES - mesh_need);
    for (size_t i = 0; i < wide.nodes.size(); i++) {
        WideNode& node = wide.nodes[i];
        for (uint32_t slot = 0; slot < node.child_count; slot++)
            node.words[slot] = is_leaf(node.words[slot])
                ? meshes[binary.order[node.words[slot] & BVH_LEAF_FIRST_MASK]].root
                : node.words[slot] + first_node;
        write_node(margin, node, nodes + i * bvh_node_words);
    }
}

} // namespace vkpt
