// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/iqm_skeleton.hpp"

#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace formats {

using namespace iqm_disk;

void Skeleton::Matrix::move(glm::vec3& position, glm::vec3& normal) const
{
    position = matrix * position + offset;
    // The cofactors are the inverse's transpose times the determinant: they need no division.
    const glm::vec3 turned = normal.x * glm::cross(matrix[1], matrix[2]) + normal.y * glm::cross(matrix[2], matrix[0])
        + normal.z * glm::cross(matrix[0], matrix[1]);
    const float length = glm::length(turned);
    if (length > 0 && std::isfinite(length))
        normal = turned / (glm::determinant(matrix) < 0 ? -length : length);
}

Skeleton::Skeleton(ByteReader& reader, const Header& header)
{
    if (header.joint_count == 0 || header.pose_count == 0 || header.frame_count == 0)
        return;
    read_joints(reader, header);
    read_frames(reader, header);
}

void Skeleton::read_joints(ByteReader& reader, const Header& header)
{
    const auto joints = reader.read_array<Joint>(header.joints, header.joint_count, "joints");
    std::vector<Placing> bind;
    for (size_t i = 0; i < joints.size(); i++) {
        const Joint& joint = joints[i];
        const auto refuse = [&](const std::string& reason) {
            reader.fail_at(header.joints + i * sizeof(Joint), "joint " + std::to_string(i) + ": " + reason);
        };
        if (joint.parent >= int64_t(i))
            refuse("its parent " + std::to_string(joint.parent) + " does not come before it; export the skeleton anew");
        const Placing own = make_placing(joint.translation, joint.rotation, joint.scale);
        bind.push_back(joint.parent < 0 ? own : compose(bind[size_t(joint.parent)], own));
        const glm::dmat3 inverse = glm::inverse(bind[i].matrix);
        const glm::dvec3 offset = -(inverse * bind[i].offset);
        double sum = 0; // finite where all are
        for (int axis = 0; axis < 3; axis++)
            sum += std::abs(offset[axis]) + glm::length(inverse[axis]);
        if (!std::isfinite(sum))
            refuse("its place or scale is not a sensible number");
        parents_.push_back(joint.parent);
        from_bind_.push_back({ inverse, offset });
    }
}

void Skeleton::read_frames(ByteReader& reader, const Header& header)
{
    poses_ = reader.read_array<Pose>(header.poses, header.pose_count, "poses");
    size_t moving = 0;
    for (const Pose& pose : poses_)
        moving += size_t(std::popcount(pose.mask & ((1u << channels) - 1)));
    if (moving != header.channel_count)
        reader.fail_at(header_at + offsetof(Header, channel_count),
            std::to_string(header.channel_count) + " numbers for each frame, while its poses have "
                + std::to_string(moving));
    frame_count_ = header.frame_count;
    numbers_ = reader.read_array<uint16_t>(header.frames, frame_count_ * moving, "frames");
}

Skeleton::Placing Skeleton::make_placing(glm::dvec3 translation, glm::dvec4 rotation, glm::dvec3 scale)
{
    const double length = glm::length(rotation);
    const glm::dquat turn = length > 0
        ? glm::dquat(rotation.w / length, rotation.x / length, rotation.y / length, rotation.z / length)
        : glm::dquat(1, 0, 0, 0);
    glm::dmat3 matrix = glm::mat3_cast(turn);
    for (int axis = 0; axis < 3; axis++)
        matrix[axis] *= scale[axis]; // first of all
    return { matrix, translation };
}

Skeleton::Placing Skeleton::compose(const Placing& outer, const Placing& inner)
{
    return { outer.matrix * inner.matrix, outer.matrix * inner.offset + outer.offset };
}

std::vector<Skeleton::Matrix> Skeleton::find_matrices(size_t frame) const
{
    std::vector<Placing> placings;
    std::vector<Matrix> matrices;
    const uint16_t* number = numbers_.data() + (poses_.empty() ? 0 : frame * (numbers_.size() / frame_count_));
    for (size_t joint = 0; joint < poses_.size(); joint++) {
        const Pose& pose = poses_[joint];
        std::array<double, channels> value;
        for (size_t i = 0; i < channels; i++)
            value[i] = double(pose.offset[i]) + (pose.mask >> i & 1 ? double(*number++) * double(pose.scale[i]) : 0);
        const Placing own = make_placing({ value[0], value[1], value[2] }, { value[3], value[4], value[5], value[6] },
            { value[7], value[8], value[9] });
        placings.push_back(parents_[joint] < 0 ? own : compose(placings[size_t(parents_[joint])], own));
        const Placing whole = compose(placings[joint], from_bind_[joint]);
        matrices.push_back({ glm::mat3(whole.matrix), glm::vec3(whole.offset) });
    }
    return matrices;
}

Skeleton::Matrix blend(const std::vector<Skeleton::Matrix>& matrices, glm::u8vec4 joints, glm::vec4 weights)
{
    Skeleton::Matrix sum { glm::mat3(0), glm::vec3(0) };
    for (int i = 0; i < 4; i++)
        if (weights[i] > 0) {
            const Skeleton::Matrix& matrix = matrices[joints[i]];
            sum.matrix += weights[i] * matrix.matrix;
            sum.offset += weights[i] * matrix.offset;
        }
    return sum;
}

} // namespace formats
