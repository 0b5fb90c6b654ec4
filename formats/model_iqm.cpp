// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/model_iqm.hpp"
#include "formats/iqm_disk.hpp"
#include "formats/iqm_skeleton.hpp"
#include "formats/model.hpp"
#include "formats/model_limits.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>

namespace formats {

using namespace iqm_disk;

namespace {

Header read_header(ByteReader& reader)
{
    if (reader.read<std::array<char, 16>>() != magic)
        reader.fail_at(0, "not an IQM model (no \"INTERQUAKEMODEL\")");
    if (const auto found = reader.read<uint32_t>(); found != version)
        reader.fail_at(sizeof(magic), "IQM version " + std::to_string(found) + "; export the model as version 2");
    const auto header = reader.read<Header>();
    const auto refuse = [&](size_t field, const std::string& reason) { reader.fail_at(header_at + field, reason); };
    if (header.file_size > reader.size())
        refuse(offsetof(Header, file_size),
            "the file ends before its " + std::to_string(header.file_size) + " bytes; copy it again");
    if (header.mesh_count == 0 || header.mesh_count > max_meshes)
        refuse(offsetof(Header, mesh_count),
            std::to_string(header.mesh_count) + " meshes; a model has 1 to " + std::to_string(max_meshes)
                + ": join some");
    if (header.joint_count > max_joints)
        refuse(offsetof(Header, joint_count),
            std::to_string(header.joint_count) + " joints, more than the " + std::to_string(max_joints)
                + " that a model may have");
    if (header.pose_count != 0 && header.pose_count != header.joint_count)
        refuse(offsetof(Header, pose_count),
            std::to_string(header.pose_count) + " poses for " + std::to_string(header.joint_count)
                + " joints; export skeleton and animations together");
    if (header.frame_count > max_frames)
        refuse(offsetof(Header, frame_count),
            std::to_string(header.frame_count) + " frames, more than the " + std::to_string(max_frames)
                + " that a model may have");
    return header;
}

// Each vertex as the file has it.
struct Vertices {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> coordinates;
    std::vector<glm::u8vec4> joints; // empty: nothing moves
    std::vector<glm::vec4> weights; // add up to 1, or all are 0
};

class Reader {
public:
    Reader(Bytes file, std::string_view name)
        : reader_(file, name)
        , folder_(name.substr(0, name.rfind('/') == name.npos ? 0 : name.rfind('/') + 1))
        , header_(read_header(reader_))
    {
    }

    std::vector<Md2Model> read()
    {
        read_vertices();
        std::vector<Md2Model> models;
        ExpandedSize expanded;
        const Skeleton skeleton(reader_, header_);
        size_t triangles = 0;
        meshes_ = reader_.read_array<Mesh>(header_.meshes, header_.mesh_count, "meshes");
        for (size_t i = 0; i < meshes_.size(); i++) {
            check_mesh(i, triangles);
            expanded.add(reader_, mesh_place(i), skeleton.frame_count(), meshes_[i].vertex_count);
            models.push_back(read_mesh(i));
        }
        for (size_t frame = 0; frame < skeleton.frame_count(); frame++) {
            const std::vector<Skeleton::Matrix> matrices = skeleton.find_matrices(frame);
            for (size_t i = 0; i < meshes_.size(); i++)
                models[i].frames.push_back(make_frame(meshes_[i], matrices, frame));
        }
        return models;
    }

private:
    size_t mesh_place(size_t mesh) const { return header_.meshes + mesh * sizeof(Mesh); }

    void read_vertices()
    {
        const auto arrays = reader_.read_array<VertexArray>(header_.arrays, header_.array_count, "vertex arrays");
        for (size_t i = 0; i < arrays.size(); i++)
            if (arrays[i].type < TypeCount)
                arrays_[arrays[i].type] = i;
        const auto read_floats = [&]<class T>(ArrayType type, std::vector<T>& target, const char* what) {
            const VertexArray& array = find_array(arrays, type, what);
            if (array.format != Float || array.size != uint32_t(T::length()))
                refuse_array(type, what);
            target = reader_.read_array<T>(array.offset, header_.vertex_count, what);
            return array.offset;
        };
        read_floats(Position, vertices_.positions, "positions");
        read_floats(Normal, vertices_.normals, "normals");
        const size_t place = read_floats(TextureCoordinate, vertices_.coordinates, "texture coordinates");
        check_texture_coordinates(reader_, place, vertices_.coordinates);
        check_vertices(arrays);
        if (header_.joint_count > 0 && header_.pose_count > 0) {
            read_joints(find_array(arrays, BlendIndices, "blend indices"));
            read_weights(find_array(arrays, BlendWeights, "blend weights"));
        }
    }

    const VertexArray& find_array(const std::vector<VertexArray>& arrays, ArrayType type, const char* what)
    {
        if (!arrays_[type])
            reader_.fail_at(header_at + offsetof(Header, array_count),
                std::string("the vertices have no ") + what + "; export the model with them");
        return arrays[*arrays_[type]];
    }

    [[noreturn]] void refuse_array(ArrayType type, const char* what)
    {
        reader_.fail_at(header_.arrays + *arrays_[type] * sizeof(VertexArray),
            std::string(what) + " in a format that is not known; export them as iqm.txt recommends");
    }

    void check_vertices(const std::vector<VertexArray>& arrays)
    {
        for (size_t i = 0; i < vertices_.positions.size(); i++) {
            if (!is_sane_position(vertices_.positions[i]))
                reader_.fail_at(arrays[*arrays_[Position]].offset + i * sizeof(glm::vec3),
                    "a position is not a sensible number; export the model anew");
            glm::vec3& normal = vertices_.normals[i];
            const float length = glm::length(normal);
            if (!std::isfinite(length))
                reader_.fail_at(arrays[*arrays_[Normal]].offset + i * sizeof(glm::vec3),
                    "a normal is not a sensible number; export the model anew");
            normal = length > 0 ? normal / length : glm::vec3(0, 0, 1);
        }
    }

    void read_joints(const VertexArray& array)
    {
        if (array.size != 4 || (array.format != UnsignedByte && array.format != Int && array.format != UnsignedInt))
            refuse_array(BlendIndices, "blend indices");
        if (array.format == UnsignedByte) {
            vertices_.joints = reader_.read_array<glm::u8vec4>(array.offset, header_.vertex_count, "blend indices");
            return;
        }
        // Above 255: no joint, which only a weight of 0 makes good.
        for (const auto& four : reader_.read_array<glm::uvec4>(array.offset, header_.vertex_count, "blend indices"))
            vertices_.joints.emplace_back(glm::min(four, glm::uvec4(UINT8_MAX)));
    }

    void read_weights(const VertexArray& array)
    {
        if (array.size != 4 || (array.format != UnsignedByte && array.format != Float))
            refuse_array(BlendWeights, "blend weights");
        const size_t size = array.format == Float ? sizeof(glm::vec4) : sizeof(glm::u8vec4);
        if (array.format == Float)
            vertices_.weights = reader_.read_array<glm::vec4>(array.offset, header_.vertex_count, "blend weights");
        else
            for (const auto& four :
                reader_.read_array<glm::u8vec4>(array.offset, header_.vertex_count, "blend weights"))
                vertices_.weights.emplace_back(four);
        for (size_t i = 0; i < vertices_.weights.size(); i++) {
            glm::vec4& weights = vertices_.weights[i];
            const float sum = weights.x + weights.y + weights.z + weights.w;
            for (int k = 0; k < 4; k++) {
                if (!(weights[k] >= 0) || !std::isfinite(sum))
                    reader_.fail_at(array.offset + i * size, "a blend weight is not a sensible number");
                if (weights[k] > 0 && vertices_.joints[i][k] >= header_.joint_count)
                    reader_.fail_at(array.offset + i * size,
                        "vertex " + std::to_string(i) + " hangs on joint " + std::to_string(vertices_.joints[i][k])
                            + " of " + std::to_string(header_.joint_count));
            }
            if (sum > 0)
                weights /= sum;
        }
    }

    // Adds its triangles to `total`: all together are no more than the file has, else they cost more than they take.
    void check_mesh(size_t index, size_t& total)
    {
        const Mesh& mesh = meshes_[index];
        const auto check_run = [&](uint64_t first, uint64_t count, uint64_t size, const char* what) {
            if (count == 0 || first + count > size)
                reader_.fail_at(mesh_place(index),
                    std::string(what) + " " + std::to_string(first) + " + " + std::to_string(count) + " of "
                        + std::to_string(size));
        };
        check_run(mesh.first_vertex, mesh.vertex_count, header_.vertex_count, "vertices");
        check_run(mesh.first_triangle, mesh.triangle_count, header_.triangle_count, "triangles");
        total += mesh.triangle_count;
        if (total > header_.triangle_count)
            reader_.fail_at(mesh_place(index), "its triangles belong to another mesh already");
    }

    Md2Model read_mesh(size_t index)
    {
        const Mesh& mesh = meshes_[index];
        Md2Model model;
        model.skin_width = model.skin_height = 1; // coordinates are shares of it already
        if (const std::string material = read_text(mesh.material, mesh_place(index)); !material.empty())
            model.skins.push_back(folder_ + material + ".pcx");
        const size_t first = header_.triangles + size_t(mesh.first_triangle) * sizeof(Triangle);
        for (const Triangle& triangle : reader_.read_array<Triangle>(first, mesh.triangle_count, "triangles"))
            for (const size_t corner : { size_t(0), size_t(2), size_t(1) }) { // counter-clockwise
                const uint32_t vertex = triangle[corner] - mesh.first_vertex; // below first_vertex: beyond any count
                if (vertex >= mesh.vertex_count)
                    reader_.fail_at(first + model.indices.size() / 3 * sizeof(Triangle),
                        "a triangle refers to a vertex that its mesh does not have");
                model.indices.push_back(vertex);
            }
        const auto coordinates = vertices_.coordinates.begin() + std::ptrdiff_t(mesh.first_vertex);
        model.texture_coordinates.assign(coordinates, coordinates + std::ptrdiff_t(mesh.vertex_count));
        return model;
    }

    std::string read_text(uint32_t place, size_t asked_at)
    {
        if (place >= header_.text_size)
            return {};
        reader_.seek(size_t(header_.text) + place);
        std::string text
            = reader_.read_string(std::min({ size_t(header_.text_size - place), reader_.remaining(), max_name_size }));
        if (text.size() == max_name_size)
            reader_.fail_at(asked_at, "the name of its material is longer than 63 bytes");
        std::ranges::transform(
            text, text.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
        return text;
    }

    Md2Model::Frame make_frame(const Mesh& mesh, const std::vector<Skeleton::Matrix>& matrices, size_t number)
    {
        Md2Model::Frame frame;
        frame.positions.reserve(mesh.vertex_count);
        frame.normals.reserve(mesh.vertex_count);
        frame.mins = glm::vec3(INFINITY);
        frame.maxs = glm::vec3(-INFINITY);
        for (size_t i = mesh.first_vertex; i < size_t(mesh.first_vertex) + mesh.vertex_count; i++) {
            glm::vec3 position = vertices_.positions[i], normal = vertices_.normals[i];
            if (!matrices.empty() && vertices_.weights[i] != glm::vec4(0))
                blend(matrices, vertices_.joints[i], vertices_.weights[i]).move(position, normal);
            if (!is_sane_position(position))
                reader_.fail_at(header_.frames, "frame " + std::to_string(number) + " throws a vertex out of any map");
            frame.positions.push_back(position);
            frame.normals.push_back(normal);
            frame.mins = glm::min(frame.mins, position);
            frame.maxs = glm::max(frame.maxs, position);
        }
        return frame;
    }

    ByteReader reader_;
    std::string folder_; // of the file, with its final slash
    const Header header_;
    std::array<std::optional<size_t>, TypeCount> arrays_; // where in the file's list, by type
    Vertices vertices_;
    std::vector<Mesh> meshes_;
};

} // namespace

bool is_iqm(Bytes file)
{
    return file.size() >= magic.size() && std::memcmp(file.data(), magic.data(), magic.size()) == 0;
}

std::vector<Md2Model> read_iqm(Bytes file, std::string_view name) { return Reader(file, name).read(); }

} // namespace formats
