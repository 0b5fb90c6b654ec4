// SPDX-License-Identifier: GPL-2.0-or-later
// Two levels of the software backend's tree for what moves. A BLAS is made once, for its topology; every frame
// each copy that is shown gets its boxes anew ("refit"), in world space, and a small tree is built over the copies. As
// all of it stands in one array of nodes and in one space, an entry of the TLAS is just the index of a mesh's
// root: the traversal knows nothing of levels.
//
// Nodes of a frame: the TLAS's, as many as there are meshes (or one); then those of each mesh in turn.
#pragma once

#include "ref_vkpt/rays/wide_tree.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

// The traversal's stack is shared out: a BLAS gets this much, the TLAS what the meshes leave, which is
// enough for max_moving_meshes.
inline constexpr uint32_t mesh_stack_budget = 36;
inline constexpr uint32_t max_mesh_triangles = 1u << 17;
inline constexpr uint32_t max_moving_meshes = 1u << 12;

struct MeshTree {
    std::vector<uint32_t> words; // BVH_WIDTH per node; nodes and slots count from the mesh's first
    std::vector<uint32_t> order; // slot -> triangle
    uint32_t node_count = 0; // every node stands before its children
    uint32_t stack_need = 0; // at most mesh_stack_budget

    uint32_t slot_count() const { return uint32_t(order.size()); }
};

// `boxes`: one per triangle, at most max_mesh_triangles, in some pose.
MeshTree build_mesh_tree(std::span<const Box> boxes);

// Writes the mesh's nodes at `nodes`, whose words count as `place` says. `corners`: three indices into `points` per
// slot, which stand in world space; NaNs among them leave the boxes alone. Returns what bounds the mesh. `scratch`: of
// this thread.
Box refit(const MeshTree& tree, std::span<const uint32_t> corners, const Float4* points, float margin,
    const TreePlace& place, uint32_t* nodes, std::vector<Box4>& scratch);

// A tree that was made for one frame takes its place among the meshes.
void write_mesh(const WideTree& tree, float margin, const TreePlace& place, uint32_t* nodes);

struct MovingMesh {
    Box box;
    uint32_t root = 0; // node, among all
    uint32_t stack_need = 0;
};

// Writes the TLAS at nodes[0 ..], which is node `first_node`, at most tlas_node_count() nodes. No ray needs more
// than TRACE_STACK_ENTRIES for it and the meshes together, of which there are at most max_moving_meshes.
void write_tlas(std::span<const MovingMesh> meshes, float margin, uint32_t first_node, uint32_t* nodes);
inline uint32_t tlas_node_count(uint32_t meshes) { return meshes > 1 ? meshes : 1; }

} // namespace vkpt
