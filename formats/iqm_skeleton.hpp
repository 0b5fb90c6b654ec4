// SPDX-License-Identifier: GPL-2.0-or-later
// The joints of an IQM, and where its frames put them.
#pragma once

#include "formats/byte_reader.hpp"
#include "formats/iqm_disk.hpp"

#include <glm/gtc/type_precision.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace formats {

class Skeleton {
public:
    // From where a vertex was fixed to where it is: matrix * p + offset.
    struct Matrix {
        glm::mat3 matrix { 1 };
        glm::vec3 offset { 0 };
        // The normal, a unit vector, stays square to the surface; where the matrix flattens it, it is left as it is.
        void move(glm::vec3& position, glm::vec3& normal) const;
    };

    // Throws FormatError. Each parent comes before its children, so that there are no rings.
    Skeleton(ByteReader& reader, const iqm_disk::Header& header);

    size_t frame_count() const { return frame_count_; } // at least 1: the pose that the vertices lie in
    // One for each joint; none: nothing moves.
    std::vector<Matrix> find_matrices(size_t frame) const;

private:
    struct Placing {
        glm::dmat3 matrix { 1 };
        glm::dvec3 offset { 0 };
    };
    static Placing make_placing(glm::dvec3 translation, glm::dvec4 rotation, glm::dvec3 scale);
    static Placing compose(const Placing& outer, const Placing& inner);
    void read_joints(ByteReader& reader, const iqm_disk::Header& header);
    void read_frames(ByteReader& reader, const iqm_disk::Header& header);

    std::vector<int32_t> parents_;
    std::vector<Placing> from_bind_; // of each joint: from the model's space to the joint's
    std::vector<iqm_disk::Pose> poses_;
    size_t frame_count_ = 1;
    std::vector<uint16_t> numbers_; // frame by frame, pose by pose
};

// The weighted sum; the weights add up to 1.
Skeleton::Matrix blend(const std::vector<Skeleton::Matrix>& matrices, glm::u8vec4 joints, glm::vec4 weights);

} // namespace formats
