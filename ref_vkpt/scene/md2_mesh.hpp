// SPDX-License-Identifier: GPL-2.0-or-later
// An MD2 model made ready to be posed for many entities every frame: planar arrays for vector registers, triangles in
// the order of its tree's leaves.
#pragma once

#include "formats/model.hpp"
#include "ref_vkpt/rays/moving_bvh.hpp"
#include "ref_vkpt/scene/entity_geometry.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace vkpt {

// Left-handed players see their weapon mirrored: plane through the camera, its normal the camera's right vector.
struct Mirror {
    glm::vec3 point, normal;
};

// Scales about the eye: by `along` in the line of sight, by `across` in every direction square to it.
struct Squeeze {
    glm::vec3 eye, forward;
    float along = 1, across = 1;
};

struct Md2Pose {
    Transform transform;
    int frame = 0, old_frame = 0; // out of range: the nearest one
    float backlerp = 0; // 0: frame, 1: old_frame
    float shell_distance = 0; // pushes all positions out along their normals
    std::optional<Mirror> mirror;
    std::optional<Squeeze> squeeze; // of positions; normals stay
};
inline constexpr float powerup_shell_distance = 4; // quad damage and its like, around a player or monster
inline constexpr float weapon_shell_distance = 0.5f; // around a view weapon, where 4 units would fill the screen

class Md2Mesh {
public:
    explicit Md2Mesh(const formats::Md2Model& model);

    size_t frame_count() const { return frames_.size(); }
    uint32_t triangle_count() const { return tree_.slot_count(); }
    // node_count 0: the model is too large for one.
    const MeshTree& tree() const { return tree_; }
    // Per slot of the tree: three indices of points, and their texture coordinates.
    std::span<const uint32_t> corners() const { return corners_; }
    std::span<const std::array<glm::vec2, 3>> uvs() const { return uvs_; }

    // False where numbers are not finite or far outside of any map, in the pose or in the frames that it shows.
    bool can_pose(const Md2Pose& pose) const;
    // In world space; may be larger than what pose() gives. The pose is one that can_pose().
    Box bounds(const Md2Pose& pose) const;
    // World positions, and in the fourth lane the normal's bits (see encode_octahedral), of every point.
    void pose(const Md2Pose& pose, std::vector<Float4>& points) const;

private:
    struct Frame {
        std::vector<Float4> data; // for every four points their x, y, z, and their normals' x, y, z
        Box box;
        bool usable = false;
    };
    struct Blend {
        const Frame *frame, *old_frame;
        float backlerp;
    };
    const Frame& pick(int frame) const;
    Blend find_blend(const Md2Pose& pose) const;
    static Frame make_frame(const formats::Md2Model::Frame& source, size_t points);
    void make_tree(const formats::Md2Model& model);

    size_t point_count_;
    std::vector<Frame> frames_;
    MeshTree tree_;
    std::vector<uint32_t> corners_;
    std::vector<std::array<glm::vec2, 3>> uvs_;
};

} // namespace vkpt
