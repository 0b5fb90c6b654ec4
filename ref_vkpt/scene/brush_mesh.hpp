// SPDX-License-Identifier: GPL-2.0-or-later
// A brush model (door, lift, train) made ready to be posed every frame: triangles in the order of its tree's leaves.
#pragma once

#include "ref_vkpt/rays/moving_bvh.hpp"
#include "ref_vkpt/scene/entity_geometry.hpp"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

struct BrushMesh {
    MeshTree tree; // node_count 0: the model is too large for one
    std::vector<uint32_t> corners; // per slot three indices of points
    std::vector<Float4> points; // model space
    std::vector<shared::Triangle> triangles; // per slot, model space; material: index into `texinfos`
    std::vector<uint32_t> masks; // per slot
    std::vector<uint32_t> texinfos; // those that occur, ascending
    Box box;
    bool usable = false; // no: no triangles, or some far outside of any map
};

// `triangles`: in model space, material = texinfo.
BrushMesh make_brush_mesh(std::span<const shared::Triangle> triangles, std::span<const uint32_t> masks);

Box bounds_of(const BrushMesh& mesh, const Transform& transform);
// World space.
void pose_points(const BrushMesh& mesh, const Transform& transform, std::vector<Float4>& points);

} // namespace vkpt
