// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/byte_writer.hpp"
#include "formats/image.hpp"
#include "formats/md2_disk.hpp"
#include "formats/model.hpp"
#include "formats/model_limits.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <unordered_map>

namespace formats {

using namespace md2_disk;

namespace {

Header read_header(ByteReader& reader)
{
    if (reader.read<std::array<char, 4>>() != ident)
        reader.fail_at(0, "not an MD2 model (no \"IDP2\")");
    if (const auto found = reader.read<int32_t>(); found != version)
        reader.fail_at(4, "MD2 version " + std::to_string(found) + "; Quake II's models have version 8");
    const size_t start = reader.position();
    const auto header = reader.read<Header>();
    if (header.skin_width < 1 || header.skin_height < 1 || header.skin_width > max_image_size
        || header.skin_height > max_image_size)
        reader.fail_at(start, "the size of the skin is invalid");
    if (header.frame_count == 0 || header.triangle_count == 0)
        reader.fail_at(start, "a model without frames or triangles");
    if (header.frame_size < sizeof(FrameHeader) + uint64_t(header.vertex_count) * sizeof(Vertex))
        reader.fail_at(start + offsetof(Header, frame_size), "the frames are too small for their vertices");
    return header;
}

// Vertex of the file behind each vertex of the mesh.
using Sources = std::vector<uint16_t>;

Sources join_corners(ByteReader& reader, const Header& header, Md2Model& model)
{
    const auto coordinates
        = reader.read_array<Coordinate>(header.coordinates, header.coordinate_count, "texture coordinates");
    const auto triangles = reader.read_array<Triangle>(header.triangles, header.triangle_count, "triangles");
    std::unordered_map<uint32_t, uint32_t> known;
    Sources sources;
    model.indices.reserve(triangles.size() * 3);
    for (const Triangle& triangle : triangles) {
        for (const int corner : { 0, 2, 1 }) { // counter-clockwise
            const uint16_t vertex = triangle.vertices[corner], coordinate = triangle.coordinates[corner];
            if (vertex >= header.vertex_count || coordinate >= coordinates.size())
                reader.fail_at(header.triangles + size_t(&triangle - triangles.data()) * sizeof(Triangle),
                    "a triangle refers to a vertex that does not exist");
            const auto [entry, is_new]
                = known.try_emplace(uint32_t(vertex) << 16 | coordinate, uint32_t(sources.size()));
            if (is_new) {
                sources.push_back(vertex);
                const auto [s, t] = coordinates[coordinate];
                model.texture_coordinates.emplace_back(
                    (s + 0.5f) / float(header.skin_width), (t + 0.5f) / float(header.skin_height));
            }
            model.indices.push_back(entry->second);
        }
    }
    return sources;
}

Md2Model::Frame read_frame(ByteReader& reader, const Header& header, size_t offset, const Sources& sources)
{
    reader.seek(offset);
    Md2Model::Frame frame;
    const auto scale = reader.read<glm::vec3>(), translate = reader.read<glm::vec3>();
    frame.name = reader.read_string(frame_name_size);
    frame.mins = translate;
    frame.maxs = translate + scale * 255.f;
    if (!is_sane_position(frame.mins) || !is_sane_position(frame.maxs))
        reader.fail_at(offset, "the frame's scale or position is invalid");
    const auto vertices
        = reader.read_array<Vertex>(offset + sizeof(FrameHeader), header.vertex_count, "frame vertices");
    const auto directions = normal_directions();
    frame.positions.reserve(sources.size());
    frame.normals.reserve(sources.size());
    for (const uint16_t source : sources) {
        const auto& [position, normal] = vertices[source];
        frame.positions.push_back(translate + scale * glm::vec3(position[0], position[1], position[2]));
        frame.normals.push_back(directions[std::min<size_t>(normal, directions.size() - 1)]);
    }
    const glm::vec3 a = frame.mins, b = frame.maxs; // a scale may be negative
    frame.mins = glm::min(a, b);
    frame.maxs = glm::max(a, b);
    return frame;
}

// The mesh as the file wants it: positions and texture coordinates apart, each stored once.
struct Packed {
    std::vector<FrameHeader> frame_headers;
    std::vector<std::vector<Vertex>> frames;
    std::vector<Coordinate> coordinates;
    std::vector<Triangle> triangles;
};

// The frame's own bounds if they hold its positions, so that what was read is written with the same steps.
std::pair<glm::vec3, glm::vec3> find_bounds(const Md2Model::Frame& frame)
{
    glm::vec3 mins(INFINITY), maxs(-INFINITY);
    for (const glm::vec3& p : frame.positions) {
        mins = glm::min(mins, p);
        maxs = glm::max(maxs, p);
    }
    const auto holds = [&](int axis) { return frame.mins[axis] <= mins[axis] && frame.maxs[axis] >= maxs[axis]; };
    if (holds(0) && holds(1) && holds(2))
        return { frame.mins, frame.maxs };
    return { mins, maxs };
}

FrameHeader make_frame_header(const Md2Model::Frame& frame)
{
    const auto [mins, maxs] = find_bounds(frame);
    FrameHeader header { (maxs - mins) / 255.f, mins, {} };
    if (!std::all_of(frame.positions.begin(), frame.positions.end(), is_sane_position))
        throw std::invalid_argument("frame \"" + frame.name + "\" has a position that is not a sensible number");
    if (frame.name.size() >= frame_name_size)
        throw std::invalid_argument("frame name \"" + frame.name + "\" is longer than 15 bytes");
    std::copy(frame.name.begin(), frame.name.end(), header.name.begin());
    return header;
}

Vertex pack_vertex(const FrameHeader& header, glm::vec3 position, glm::vec3 normal)
{
    Vertex vertex { {}, nearest_direction(normal) };
    for (int axis = 0; axis < 3; axis++) {
        const float steps = header.scale[axis] > 0 ? (position[axis] - header.translate[axis]) / header.scale[axis] : 0;
        vertex.position[size_t(axis)] = uint8_t(std::clamp(std::lround(steps), 0L, 255L));
    }
    return vertex;
}

// Vertices that agree in all frames become one; gives the file's vertex for each of the mesh.
std::vector<uint16_t> pack_vertices(const Md2Model& model, Packed& packed)
{
    for (const Md2Model::Frame& frame : model.frames)
        packed.frame_headers.push_back(make_frame_header(frame));
    packed.frames.resize(model.frames.size());
    std::map<std::vector<std::array<uint8_t, 4>>, uint16_t> known;
    std::vector<uint16_t> packed_index;
    for (size_t v = 0; v < model.vertex_count(); v++) {
        std::vector<std::array<uint8_t, 4>> key;
        for (size_t f = 0; f < model.frames.size(); f++) {
            const auto [p, n]
                = pack_vertex(packed.frame_headers[f], model.frames[f].positions[v], model.frames[f].normals[v]);
            key.push_back({ p[0], p[1], p[2], n });
        }
        const auto [entry, is_new] = known.try_emplace(key, uint16_t(known.size()));
        packed_index.push_back(entry->second);
        if (is_new)
            for (size_t f = 0; f < key.size(); f++)
                packed.frames[f].push_back({ { key[f][0], key[f][1], key[f][2] }, key[f][3] });
        if (known.size() > max_vertices)
            throw std::invalid_argument("an MD2 model holds no more than 2048 vertices");
    }
    return packed_index;
}

std::vector<uint16_t> pack_coordinates(const Md2Model& model, Packed& packed)
{
    std::map<std::pair<int16_t, int16_t>, uint16_t> known;
    std::vector<uint16_t> packed_index;
    const auto to_texel = [](float coordinate, int size) {
        return int16_t(std::clamp(std::floor(coordinate * float(size)), float(INT16_MIN), float(INT16_MAX)));
    };
    for (const glm::vec2& c : model.texture_coordinates) {
        const std::pair texel { to_texel(c.x, model.skin_width), to_texel(c.y, model.skin_height) };
        const auto [entry, is_new] = known.try_emplace(texel, uint16_t(known.size()));
        packed_index.push_back(entry->second);
        if (is_new)
            packed.coordinates.push_back({ texel.first, texel.second });
    }
    return packed_index;
}

void check_written_model(const Md2Model& model)
{
    const auto require = [](bool condition, const char* what) {
        if (!condition)
            throw std::invalid_argument(std::string("cannot write this as MD2: ") + what);
    };
    require(!model.frames.empty() && model.frames.size() <= max_frames, "1 to 512 frames");
    require(!model.indices.empty() && model.indices.size() % 3 == 0, "three indices for each triangle");
    require(model.triangle_count() <= max_triangles, "4096 triangles at most");
    require(model.skins.size() <= max_skins, "32 skins at most");
    require(model.skin_width >= 1 && model.skin_height >= 1 && model.skin_width <= max_image_size
            && model.skin_height <= max_image_size,
        "the skin's size");
    require(model.vertex_count() <= 3 * max_triangles, "12288 mesh vertices at most");
    for (const Md2Model::Frame& frame : model.frames)
        require(frame.positions.size() == model.vertex_count() && frame.normals.size() == model.vertex_count(),
            "a position and a normal for each vertex in each frame");
    for (const uint32_t index : model.indices)
        require(index < model.vertex_count(), "an index beyond the vertices");
}

// The drawing commands that the engine's own renderers use: each triangle as a strip of three, then the end mark.
size_t write_commands(ByteWriter& writer, const Packed& packed, const Md2Model& model)
{
    const size_t start = writer.position();
    for (const Triangle& triangle : packed.triangles) {
        writer.write(int32_t(3));
        for (int corner = 0; corner < 3; corner++) {
            const auto [s, t] = packed.coordinates[triangle.coordinates[corner]];
            writer.write((s + 0.5f) / float(model.skin_width));
            writer.write((t + 0.5f) / float(model.skin_height));
            writer.write(int32_t(triangle.vertices[corner]));
        }
    }
    writer.write(int32_t(0));
    return (writer.position() - start) / sizeof(int32_t);
}

} // namespace

Md2Model read_md2(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    const Header header = read_header(reader);
    Md2Model model;
    model.skin_width = header.skin_width;
    model.skin_height = header.skin_height;
    // Each table is looked up as a whole first, so that no count in the header can ask for more than the file holds.
    reader.read_array<std::array<char, skin_name_size>>(header.skins, header.skin_count, "skin names");
    reader.seek(header.skin_count > 0 ? header.skins : 0);
    // The engine chooses among the first ones only; each costs a picture.
    for (uint32_t i = 0; i < std::min<uint32_t>(header.skin_count, max_skins); i++)
        model.skins.push_back(reader.read_string(skin_name_size));
    const Sources sources = join_corners(reader, header, model);
    if (header.frames > file.size() || header.frame_count > (file.size() - header.frames) / header.frame_size)
        reader.fail_at(header.frames, "the frames reach past the end of the file");
    ExpandedSize().add(reader, 0, header.frame_count, sources.size());
    for (uint32_t i = 0; i < header.frame_count; i++)
        model.frames.push_back(read_frame(reader, header, header.frames + size_t(i) * header.frame_size, sources));
    return model;
}

std::vector<std::byte> write_md2(const Md2Model& model)
{
    check_written_model(model);
    Packed packed;
    const std::vector<uint16_t> vertices = pack_vertices(model, packed), coordinates = pack_coordinates(model, packed);
    for (size_t i = 0; i < model.indices.size(); i += 3) {
        const uint32_t a = model.indices[i], b = model.indices[i + 2], c = model.indices[i + 1]; // clockwise
        packed.triangles.push_back(
            { { vertices[a], vertices[b], vertices[c] }, { coordinates[a], coordinates[b], coordinates[c] } });
    }

    Header header {};
    header.skin_width = model.skin_width;
    header.skin_height = model.skin_height;
    header.frame_size = uint32_t(sizeof(FrameHeader) + packed.frames[0].size() * sizeof(Vertex));
    header.skin_count = uint32_t(model.skins.size());
    header.vertex_count = uint32_t(packed.frames[0].size());
    header.coordinate_count = uint32_t(packed.coordinates.size());
    header.triangle_count = uint32_t(packed.triangles.size());
    header.frame_count = uint32_t(packed.frames.size());

    ByteWriter writer;
    writer.write(ident);
    writer.write(version);
    const size_t header_at = writer.position();
    writer.write(header);
    header.skins = uint32_t(writer.position());
    for (const std::string& skin : model.skins)
        writer.write_string(skin, skin_name_size);
    header.coordinates = uint32_t(writer.position());
    writer.write_array(std::span<const Coordinate>(packed.coordinates));
    header.triangles = uint32_t(writer.position());
    writer.write_array(std::span<const Triangle>(packed.triangles));
    header.frames = uint32_t(writer.position());
    for (size_t i = 0; i < packed.frames.size(); i++) {
        writer.write(packed.frame_headers[i]);
        writer.write_array(std::span<const Vertex>(packed.frames[i]));
    }
    header.commands = uint32_t(writer.position());
    header.command_count = uint32_t(write_commands(writer, packed, model));
    header.end = uint32_t(writer.position());
    writer.patch(header_at, header);
    return writer.take();
}

} // namespace formats
