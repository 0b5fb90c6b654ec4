// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/byte_writer.hpp"
#include "formats/md3_disk.hpp"
#include "formats/model.hpp"
#include "formats/model_limits.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace formats {

using namespace md3_disk;

namespace {

constexpr float quarter = std::numbers::pi_v<float> / 2;

template <size_t size> std::string to_text(const std::array<char, size>& field)
{
    return { field.begin(), std::find(field.begin(), field.end(), '\0') };
}

Header read_header(ByteReader& reader)
{
    if (reader.read<std::array<char, 4>>() != ident)
        reader.fail_at(0, "not an MD3 model (no \"IDP3\")");
    if (const auto found = reader.read<int32_t>(); found != version)
        reader.fail_at(4, "MD3 version " + std::to_string(found) + "; export the model as version 15");
    const size_t start = reader.position();
    const auto header = reader.read<Header>();
    if (header.frame_count == 0 || header.frame_count > max_frames)
        reader.fail_at(start + offsetof(Header, frame_count),
            std::to_string(header.frame_count) + " frames; a model has 1 to " + std::to_string(max_frames));
    if (header.surface_count == 0 || header.surface_count > max_surfaces)
        reader.fail_at(start + offsetof(Header, surface_count),
            std::to_string(header.surface_count) + " surfaces; a model has 1 to " + std::to_string(max_surfaces)
                + ": join some");
    return header;
}

Surface read_surface_header(ByteReader& reader, size_t start, uint32_t frame_count)
{
    reader.seek(start);
    const auto surface = reader.read<Surface>();
    const std::string name = "surface \"" + to_text(surface.name) + "\": ";
    if (surface.ident != ident)
        reader.fail_at(start, "no surface begins here (no \"IDP3\")");
    if (surface.frame_count != frame_count)
        reader.fail_at(start + offsetof(Surface, frame_count), name + "it has not as many frames as the model");
    if (surface.vertex_count == 0 || surface.vertex_count > max_vertices)
        reader.fail_at(start + offsetof(Surface, vertex_count),
            name + std::to_string(surface.vertex_count) + " vertices; 1 to " + std::to_string(max_vertices)
                + " are possible: split it");
    if (surface.triangle_count == 0 || surface.triangle_count > max_triangles)
        reader.fail_at(start + offsetof(Surface, triangle_count),
            name + std::to_string(surface.triangle_count) + " triangles; 1 to " + std::to_string(max_triangles)
                + " are possible: split it");
    return surface;
}

void read_triangles(ByteReader& reader, size_t start, const Surface& surface, Md2Model& model)
{
    const size_t first = start + surface.triangles;
    for (const Triangle& triangle : reader.read_array<Triangle>(first, surface.triangle_count, "triangles"))
        for (const size_t corner : { size_t(0), size_t(2), size_t(1) }) { // counter-clockwise
            if (triangle[corner] >= surface.vertex_count)
                reader.fail_at(first + model.indices.size() / 3 * sizeof(Triangle),
                    "a triangle refers to a vertex that does not exist");
            model.indices.push_back(triangle[corner]);
        }
}

glm::vec3 unpack_normal(const Vertex& vertex)
{
    const float inclination = float(vertex.inclination) * quarter / 64, azimuth = float(vertex.azimuth) * quarter / 64;
    return { std::sin(inclination) * std::cos(azimuth), std::sin(inclination) * std::sin(azimuth),
        std::cos(inclination) };
}

Md2Model::Frame unpack_frame(const Frame& source, const Vertex* vertices, size_t count)
{
    Md2Model::Frame frame;
    frame.name = to_text(source.name);
    frame.positions.reserve(count);
    frame.normals.reserve(count);
    frame.mins = glm::vec3(INFINITY);
    frame.maxs = glm::vec3(-INFINITY);
    for (size_t i = 0; i < count; i++) {
        const auto& [x, y, z] = vertices[i].position;
        const glm::vec3 position = glm::vec3(x, y, z) / steps_per_unit;
        frame.positions.push_back(position);
        frame.normals.push_back(unpack_normal(vertices[i]));
        frame.mins = glm::min(frame.mins, position);
        frame.maxs = glm::max(frame.maxs, position);
    }
    return frame;
}

Md2Model read_surface(ByteReader& reader, size_t start, const Surface& surface, const std::vector<Frame>& frames)
{
    Md2Model model;
    model.skin_width = model.skin_height = 1; // coordinates are shares of it already
    const auto shaders = reader.read_array<Shader>(start + surface.shaders, surface.shader_count, "skins");
    for (size_t i = 0; i < std::min(shaders.size(), max_shaders); i++)
        model.skins.push_back(to_text(shaders[i].name));
    read_triangles(reader, start, surface, model);
    const size_t coordinates = start + surface.coordinates;
    model.texture_coordinates = reader.read_array<Coordinate>(coordinates, surface.vertex_count, "texture coordinates");
    check_texture_coordinates(reader, coordinates, model.texture_coordinates);
    const auto vertices = reader.read_array<Vertex>(
        start + surface.vertices, size_t(surface.vertex_count) * frames.size(), "frame vertices");
    for (size_t f = 0; f < frames.size(); f++)
        model.frames.push_back(unpack_frame(frames[f], &vertices[f * surface.vertex_count], surface.vertex_count));
    return model;
}

Vertex pack_vertex(glm::vec3 position, glm::vec3 normal)
{
    Vertex vertex {};
    for (int axis = 0; axis < 3; axis++) {
        const float steps = std::round(position[axis] * steps_per_unit);
        if (!(std::abs(steps) <= float(INT16_MAX)))
            throw std::invalid_argument("an MD3 model reaches 511 units from its origin at most");
        vertex.position[size_t(axis)] = int16_t(steps);
    }
    const auto to_byte = [](float angle) { return uint8_t(std::lround(angle * 64 / quarter) & 255); };
    vertex.inclination = to_byte(std::acos(std::clamp(normal.z, -1.f, 1.f)));
    vertex.azimuth = to_byte(std::atan2(normal.y, normal.x));
    return vertex;
}

void write_surface(ByteWriter& writer, const Md2Model& model)
{
    const size_t start = writer.position();
    const auto offset = [&] { return uint32_t(writer.position() - start); };
    Surface surface {};
    surface.ident = ident;
    surface.frame_count = uint32_t(model.frames.size());
    surface.shader_count = uint32_t(model.skins.size());
    surface.vertex_count = uint32_t(model.vertex_count());
    surface.triangle_count = uint32_t(model.triangle_count());
    writer.write(surface);
    surface.triangles = offset();
    for (size_t i = 0; i < model.indices.size(); i += 3) // clockwise
        writer.write(Triangle { model.indices[i], model.indices[i + 2], model.indices[i + 1] });
    surface.shaders = offset();
    for (size_t i = 0; i < model.skins.size(); i++) {
        writer.write_string(model.skins[i], path_size);
        writer.write(uint32_t(i));
    }
    surface.coordinates = offset();
    writer.write_array(std::span<const Coordinate>(model.texture_coordinates));
    surface.vertices = offset();
    for (const Md2Model::Frame& frame : model.frames)
        for (size_t i = 0; i < model.vertex_count(); i++)
            writer.write(pack_vertex(frame.positions[i], frame.normals[i]));
    surface.end = offset();
    writer.patch(start, surface);
}

void check_written_surfaces(std::span<const Md2Model> surfaces)
{
    const auto require = [](bool condition, const char* what) {
        if (!condition)
            throw std::invalid_argument(std::string("cannot write this as MD3: ") + what);
    };
    require(!surfaces.empty() && surfaces.size() <= max_surfaces, "1 to 32 surfaces");
    for (const Md2Model& model : surfaces) {
        require(model.frames.size() == surfaces[0].frames.size(), "as many frames in all surfaces");
        require(!model.frames.empty() && model.frames.size() <= max_frames, "1 to 1024 frames");
        require(model.vertex_count() > 0 && model.vertex_count() <= max_vertices, "1 to 4096 vertices in a surface");
        require(model.triangle_count() > 0 && model.triangle_count() <= max_triangles && model.indices.size() % 3 == 0,
            "1 to 8192 triangles in a surface");
        for (const Md2Model::Frame& frame : model.frames)
            require(frame.positions.size() == model.vertex_count() && frame.normals.size() == model.vertex_count(),
                "a position and a normal for each vertex in each frame");
        for (const uint32_t index : model.indices)
            require(index < model.vertex_count(), "an index beyond the vertices");
    }
}

// Of a frame of all surfaces, as their positions are stored.
Frame pack_frame(std::span<const Md2Model> surfaces, size_t number)
{
    Frame frame { glm::vec3(INFINITY), glm::vec3(-INFINITY), {}, 0, {} };
    for (const Md2Model& surface : surfaces)
        for (const glm::vec3& position : surface.frames[number].positions) {
            const glm::vec3 stored = glm::round(position * steps_per_unit) / steps_per_unit;
            frame.mins = glm::min(frame.mins, stored);
            frame.maxs = glm::max(frame.maxs, stored);
        }
    frame.radius = glm::length(glm::max(glm::abs(frame.mins), glm::abs(frame.maxs)));
    const std::string& name = surfaces[0].frames[number].name;
    std::copy_n(name.begin(), std::min(name.size(), frame_name_size - 1), frame.name.begin());
    return frame;
}

} // namespace

std::vector<Md2Model> read_md3(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    const Header header = read_header(reader);
    const auto frames = reader.read_array<Frame>(header.frames, header.frame_count, "frames");
    std::vector<Md2Model> surfaces;
    size_t start = header.surfaces;
    ExpandedSize expanded;
    for (uint32_t i = 0; i < header.surface_count; i++) {
        const Surface surface = read_surface_header(reader, start, header.frame_count);
        expanded.add(reader, start, header.frame_count, surface.vertex_count);
        surfaces.push_back(read_surface(reader, start, surface, frames));
        start += surface.end;
    }
    return surfaces;
}

std::vector<std::byte> write_md3(std::span<const Md2Model> surfaces)
{
    check_written_surfaces(surfaces);
    ByteWriter writer;
    writer.write(ident);
    writer.write(version);
    const size_t header_at = writer.position();
    Header header {};
    header.frame_count = uint32_t(surfaces[0].frames.size());
    header.surface_count = uint32_t(surfaces.size());
    writer.write(header);
    header.frames = uint32_t(writer.position());
    for (size_t i = 0; i < header.frame_count; i++)
        writer.write(pack_frame(surfaces, i));
    header.tags = header.surfaces = uint32_t(writer.position());
    for (const Md2Model& surface : surfaces)
        write_surface(writer, surface);
    header.end = uint32_t(writer.position());
    writer.patch(header_at, header);
    return writer.take();
}

} // namespace formats
