// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/bsp_disk.hpp"

#include <algorithm>
#include <cstring>

namespace formats {

using namespace bsp_disk;

namespace {

Directory read_directory(ByteReader& reader)
{
    if (reader.read<std::array<char, 4>>() != ident)
        reader.fail_at(0, "not a BSP file (no \"IBSP\")");
    if (const auto found = reader.read<int32_t>(); found != version)
        reader.fail_at(4, "BSP version " + std::to_string(found) + "; Quake II's maps have version 38");
    const auto directory = reader.read<Directory>();
    size_t total = 0;
    for (size_t lump = 0; lump < LumpCount; lump++) {
        const auto [offset, size] = directory[lump];
        if (size > 0 && (offset > reader.size() || size > reader.size() - offset))
            reader.fail_at(header_size - sizeof(Directory) + lump * sizeof(LumpEntry),
                std::string("lump ") + lump_names[lump] + " reaches past the end of the file");
        total += size;
    }
    if (total > reader.size())
        reader.fail_at(header_size - sizeof(Directory),
            "its lumps hold " + std::to_string(total) + " bytes, more than the file: they overlap");
    return directory;
}

template <class T> std::vector<T> read_lump(ByteReader& reader, const Directory& directory, Lump lump)
{
    const auto [offset, size] = directory[lump];
    if (size == 0)
        return {};
    if (size % sizeof(T) != 0)
        reader.fail_at(offset,
            std::string("lump ") + lump_names[lump] + ": " + std::to_string(size) + " bytes are not a multiple of "
                + std::to_string(sizeof(T)));
    return reader.read_array<T>(offset, size / sizeof(T), lump_names[lump]);
}

std::string text_until_zero(const char* data, size_t size)
{
    return std::string(data, std::find(data, data + size, '\0'));
}

std::vector<BspTexinfo> convert_texinfos(const std::vector<TexinfoRecord>& records)
{
    std::vector<BspTexinfo> texinfos;
    texinfos.reserve(records.size());
    for (const TexinfoRecord& r : records)
        texinfos.push_back({ r.s_axis, r.s_offset, r.t_axis, r.t_offset, r.flags, r.value,
            text_until_zero(r.texture.data(), r.texture.size()), r.next });
    return texinfos;
}

} // namespace

Bsp read_bsp(Bytes file, std::string_view name)
{
    ByteReader reader(file, name);
    const Directory directory = read_directory(reader);
    Bsp bsp;
    bsp.name = name;
    bsp.file_size = file.size();
    const auto entity_text = read_lump<char>(reader, directory, Entities);
    bsp.entity_text = text_until_zero(entity_text.data(), entity_text.size());
    bsp.planes = read_lump<BspPlane>(reader, directory, Planes);
    bsp.vertices = read_lump<glm::vec3>(reader, directory, Vertices);
    bsp.visibility = read_lump<uint8_t>(reader, directory, Visibility);
    bsp.nodes = read_lump<BspNode>(reader, directory, Nodes);
    bsp.texinfos = convert_texinfos(read_lump<TexinfoRecord>(reader, directory, Texinfos));
    bsp.faces = read_lump<BspFace>(reader, directory, Faces);
    bsp.lighting = read_lump<uint8_t>(reader, directory, Lighting);
    bsp.leaves = read_lump<BspLeaf>(reader, directory, Leaves);
    bsp.leaf_faces = read_lump<uint16_t>(reader, directory, LeafFaces);
    bsp.leaf_brushes = read_lump<uint16_t>(reader, directory, LeafBrushes);
    bsp.edges = read_lump<BspEdge>(reader, directory, Edges);
    bsp.surface_edges = read_lump<int32_t>(reader, directory, SurfaceEdges);
    bsp.models = read_lump<BspModel>(reader, directory, Models);
    bsp.brushes = read_lump<BspBrush>(reader, directory, Brushes);
    bsp.brush_sides = read_lump<BspBrushSide>(reader, directory, BrushSides);
    bsp.areas = read_lump<BspArea>(reader, directory, Areas);
    bsp.area_portals = read_lump<BspAreaPortal>(reader, directory, AreaPortals);
    if (!bsp.visibility.empty()) {
        if (bsp.visibility.size() < sizeof(int32_t))
            reader.fail_at(directory[Visibility].offset, "lump visibility: too short for its cluster count");
        std::memcpy(&bsp.cluster_count, bsp.visibility.data(), sizeof(int32_t));
    }
    check(bsp, directory, name);
    return bsp;
}

} // namespace formats
