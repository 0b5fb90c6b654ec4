// SPDX-License-Identifier: GPL-2.0-or-later
// How BSP version 38 lies on disk: the lump directory, and the one record whose layout differs from memory.
#pragma once

#include "formats/bsp.hpp"

#include <array>
#include <cstdint>

namespace formats::bsp_disk {

inline constexpr std::array<char, 4> ident { 'I', 'B', 'S', 'P' };
inline constexpr int32_t version = 38;

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
inline constexpr size_t header_size = sizeof(ident) + sizeof(version) + sizeof(Directory);

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

// Fails with the lump, the record and its byte offset. Also sets light_offset to -1 where samples are missing.
void check(Bsp& bsp, const Directory& directory, std::string_view file);

} // namespace formats::bsp_disk
