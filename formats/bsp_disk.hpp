// SPDX-License-Identifier: GPL-2.0-or-later
// How BSP version 38 lies on disk: the lump directory, the records of either format, and the list of all lumps from
// which both are read, written and checked. Sources: id Software's qfiles.h (IBSP); ericw-tools and Q2RTX (QBSP).
#pragma once

#include "formats/bsp.hpp"

#include <array>
#include <cstdint>
#include <type_traits>

namespace formats::bsp_disk {

using Ident = std::array<char, 4>;
inline constexpr Ident ident { 'I', 'B', 'S', 'P' }, extended_ident { 'Q', 'B', 'S', 'P' };
inline constexpr int32_t version = 38; // of both

enum Lump {
    Entities,
    Planes,
    Vertices,
    Visibility,
    Nodes,
    Texinfos,
    Faces,
    Lighting,
    Leaves,
    LeafFaces,
    LeafBrushes,
    Edges,
    SurfaceEdges,
    Models,
    Brushes,
    BrushSides,
    Pop, // 256 bytes nobody reads
    Areas,
    AreaPortals,
    LumpCount,
};

inline constexpr std::array<const char*, LumpCount> lump_names { "entities", "planes", "vertices", "visibility",
    "nodes", "texinfos", "faces", "lighting", "leaves", "leaf faces", "leaf brushes", "edges", "surface edges",
    "models", "brushes", "brush sides", "pop", "areas", "area portals" };

struct LumpEntry {
    uint32_t offset, size;
};
using Directory = std::array<LumpEntry, LumpCount>;
inline constexpr size_t directory_at = sizeof(Ident) + sizeof(version);
inline constexpr size_t header_size = directory_at + sizeof(Directory);

inline constexpr size_t texture_name_size = 32;
struct TexinfoRecord {
    glm::vec3 s_axis;
    float s_offset;
    glm::vec3 t_axis;
    float t_offset;
    uint32_t flags;
    int32_t value;
    std::array<char, texture_name_size> texture;
    int32_t next;
};
static_assert(sizeof(TexinfoRecord) == 76);

// IBSP's records whose fields are narrower than in memory.
struct NarrowNode {
    int32_t plane, children[2];
    int16_t mins[3], maxs[3];
    uint16_t first_face, face_count;
};
struct NarrowLeaf {
    uint32_t contents;
    int16_t cluster, area;
    int16_t mins[3], maxs[3];
    uint16_t first_leaf_face, leaf_face_count, first_leaf_brush, leaf_brush_count;
};
struct NarrowFace {
    uint16_t plane, side;
    int32_t first_edge;
    uint16_t edge_count, texinfo;
    uint8_t styles[4];
    int32_t light_offset;
};
struct NarrowEdge {
    uint16_t vertices[2];
};
struct NarrowBrushSide {
    uint16_t plane;
    int16_t texinfo;
};
static_assert(sizeof(NarrowNode) == 28 && sizeof(NarrowLeaf) == 28 && sizeof(NarrowFace) == 20);
static_assert(sizeof(NarrowEdge) == 4 && sizeof(NarrowBrushSide) == 4);

// How a record of the type T in memory lies on disk.
template <BspFormat format, class T> struct OnDisk {
    using Record = T;
};
template <BspFormat format> struct OnDisk<format, BspTexinfo> {
    using Record = TexinfoRecord;
};
template <> struct OnDisk<BspFormat::ibsp, BspNode> {
    using Record = NarrowNode;
};
template <> struct OnDisk<BspFormat::ibsp, BspLeaf> {
    using Record = NarrowLeaf;
};
template <> struct OnDisk<BspFormat::ibsp, BspFace> {
    using Record = NarrowFace;
};
template <> struct OnDisk<BspFormat::ibsp, BspEdge> {
    using Record = NarrowEdge;
};
template <> struct OnDisk<BspFormat::ibsp, BspBrushSide> {
    using Record = NarrowBrushSide;
};
template <> struct OnDisk<BspFormat::ibsp, uint32_t> { // leaf faces and leaf brushes
    using Record = uint16_t;
};

// Calls visit(lump, records) for each lump of records: all but Entities, which is text, and Pop. `Map`: Bsp or const
// Bsp.
template <class Map, class Visit> void for_each_lump(Map& bsp, Visit&& visit)
{
    visit(Planes, bsp.planes);
    visit(Vertices, bsp.vertices);
    visit(Visibility, bsp.visibility);
    visit(Nodes, bsp.nodes);
    visit(Texinfos, bsp.texinfos);
    visit(Faces, bsp.faces);
    visit(Lighting, bsp.lighting);
    visit(Leaves, bsp.leaves);
    visit(LeafFaces, bsp.leaf_faces);
    visit(LeafBrushes, bsp.leaf_brushes);
    visit(Edges, bsp.edges);
    visit(SurfaceEdges, bsp.surface_edges);
    visit(Models, bsp.models);
    visit(Brushes, bsp.brushes);
    visit(BrushSides, bsp.brush_sides);
    visit(Areas, bsp.areas);
    visit(AreaPortals, bsp.area_portals);
}

// Calls visit with `format` as a constant: std::integral_constant<BspFormat, ...>.
template <class Visit> auto with_format(BspFormat format, Visit&& visit)
{
    if (format == BspFormat::qbsp)
        return visit(std::integral_constant<BspFormat, BspFormat::qbsp>());
    return visit(std::integral_constant<BspFormat, BspFormat::ibsp>());
}

// Bytes of a record of each lump on disk; 1 where there are no records.
using RecordSizes = std::array<size_t, LumpCount>;
RecordSizes record_sizes(BspFormat format);

// Fails with the lump, the record and its byte offset. Also sets light_offset to -1 where samples are missing.
void check(Bsp& bsp, const Directory& directory, std::string_view file);

} // namespace formats::bsp_disk
