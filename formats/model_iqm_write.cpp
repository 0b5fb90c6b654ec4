// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/byte_writer.hpp"
#include "formats/iqm_disk.hpp"
#include "formats/model_iqm.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace formats {

using namespace iqm_disk;

namespace {

void require(bool condition, const char* what)
{
    if (!condition)
        throw std::invalid_argument(std::string("cannot write this as IQM: ") + what);
}

void check_written_model(const IqmModel& model)
{
    require(!model.meshes.empty() && model.meshes.size() <= max_meshes, "1 to 32 meshes");
    require(model.joints.size() <= max_joints, "256 joints at most");
    require(model.frames.size() <= max_frames, "4096 frames at most");
    for (size_t i = 0; i < model.joints.size(); i++)
        require(model.joints[i].parent < int64_t(i), "parents before their joints");
    for (const auto& frame : model.frames)
        require(!model.joints.empty() && frame.size() == model.joints.size(), "a placing for each joint in each frame");
    for (const IqmModel::Mesh& mesh : model.meshes) {
        require(!mesh.vertices.empty() && !mesh.indices.empty() && mesh.indices.size() % 3 == 0,
            "vertices, and three indices for each triangle");
        require(mesh.material.size() < max_name_size, "63 bytes of a material's name at most");
        for (const uint32_t index : mesh.indices)
            require(index < mesh.vertices.size(), "an index beyond the vertices");
    }
}

std::array<float, channels> channels_of(const IqmModel::Placing& p)
{
    return { p.translation.x, p.translation.y, p.translation.z, p.rotation.x, p.rotation.y, p.rotation.z, p.rotation.w,
        p.scale.x, p.scale.y, p.scale.z };
}

// How a joint's channels are stored: what never changes is the offset alone.
Pose make_pose(const IqmModel& model, size_t joint)
{
    Pose pose { model.joints[joint].parent, 0, {}, {} };
    for (size_t i = 0; i < channels; i++) {
        float low = INFINITY, high = -INFINITY;
        for (const auto& frame : model.frames) {
            const float value = channels_of(frame[joint])[i];
            low = std::min(low, value);
            high = std::max(high, value);
        }
        pose.offset[i] = low;
        pose.scale[i] = (high - low) / UINT16_MAX;
        pose.mask |= pose.scale[i] > 0 ? 1u << i : 0;
    }
    return pose;
}

class Writer {
public:
    explicit Writer(const IqmModel& model)
        : model_(model)
    {
        file_.write(magic);
        file_.write(version);
        file_.write(header_);
    }

    std::vector<std::byte> write()
    {
        write_meshes();
        write_arrays();
        write_triangles();
        write_joints();
        if (!model_.frames.empty())
            write_frames();
        header_.text = begin();
        header_.text_size = uint32_t(text_.size());
        file_.write_bytes(std::as_bytes(std::span(text_)));
        file_.align(4);
        header_.file_size = uint32_t(file_.position());
        file_.patch(header_at, header_);
        return file_.take();
    }

private:
    uint32_t begin()
    {
        file_.align(4);
        return uint32_t(file_.position());
    }

    uint32_t add_text(const std::string& text)
    {
        const size_t place = text_.size();
        text_ += text + '\0';
        return uint32_t(place);
    }

    void write_meshes()
    {
        header_.meshes = begin();
        header_.mesh_count = uint32_t(model_.meshes.size());
        for (const IqmModel::Mesh& mesh : model_.meshes) {
            const uint32_t vertices = uint32_t(mesh.vertices.size()), triangles = uint32_t(mesh.indices.size() / 3);
            file_.write(Mesh { add_text(mesh.name), add_text(mesh.material), header_.vertex_count, vertices,
                header_.triangle_count, triangles });
            header_.vertex_count += vertices;
            header_.triangle_count += triangles;
        }
    }

    // The array's numbers, and its place in `arrays_`.
    template <class Choose> void write_array(ArrayType type, ArrayFormat format, uint32_t size, Choose choose)
    {
        arrays_.push_back({ type, 0, format, size, begin() });
        for (const IqmModel::Mesh& mesh : model_.meshes)
            for (const IqmModel::Vertex& vertex : mesh.vertices)
                file_.write(choose(vertex));
    }

    void write_arrays()
    {
        using Vertex = IqmModel::Vertex;
        write_array(Position, Float, 3, [](const Vertex& v) { return v.position; });
        write_array(TextureCoordinate, Float, 2, [](const Vertex& v) { return v.texture_coordinate; });
        write_array(Normal, Float, 3, [](const Vertex& v) { return v.normal; });
        if (!model_.joints.empty()) {
            write_array(BlendIndices, UnsignedByte, 4, [](const Vertex& v) { return v.joints; });
            write_array(BlendWeights, UnsignedByte, 4, [](const Vertex& v) { return v.weights; });
        }
        header_.arrays = begin();
        header_.array_count = uint32_t(arrays_.size());
        file_.write_array(std::span<const VertexArray>(arrays_));
    }

    void write_triangles()
    {
        header_.triangles = begin();
        uint32_t first = 0;
        for (const IqmModel::Mesh& mesh : model_.meshes) {
            for (size_t i = 0; i < mesh.indices.size(); i += 3) // clockwise
                file_.write(
                    Triangle { first + mesh.indices[i], first + mesh.indices[i + 2], first + mesh.indices[i + 1] });
            first += uint32_t(mesh.vertices.size());
        }
    }

    void write_joints()
    {
        header_.joints = begin();
        header_.joint_count = uint32_t(model_.joints.size());
        for (const IqmModel::Joint& joint : model_.joints) {
            const glm::quat& turn = joint.bind.rotation;
            file_.write(Joint { add_text(joint.name), joint.parent, joint.bind.translation,
                { turn.x, turn.y, turn.z, turn.w }, joint.bind.scale });
        }
    }

    void write_frames()
    {
        std::vector<Pose> poses;
        for (size_t joint = 0; joint < model_.joints.size(); joint++)
            poses.push_back(make_pose(model_, joint));
        header_.poses = begin();
        header_.pose_count = uint32_t(poses.size());
        file_.write_array(std::span<const Pose>(poses));
        header_.frames = begin();
        header_.frame_count = uint32_t(model_.frames.size());
        for (const Pose& pose : poses)
            header_.channel_count += uint32_t(std::popcount(pose.mask));
        for (const auto& frame : model_.frames)
            for (size_t joint = 0; joint < poses.size(); joint++)
                for (size_t i = 0; i < channels; i++)
                    if (poses[joint].mask >> i & 1)
                        file_.write(uint16_t(std::lround(
                            (channels_of(frame[joint])[i] - poses[joint].offset[i]) / poses[joint].scale[i])));
    }

    const IqmModel& model_;
    ByteWriter file_;
    Header header_ {};
    std::vector<VertexArray> arrays_;
    std::string text_ { '\0' }; // names by their places; 0: none
};

} // namespace

std::vector<std::byte> write_iqm(const IqmModel& model)
{
    check_written_model(model);
    return Writer(model).write();
}

} // namespace formats
