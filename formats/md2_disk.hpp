// SPDX-License-Identifier: GPL-2.0-or-later
// How MD2 version 8 lies on disk.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

namespace formats::md2_disk {

inline constexpr std::array<char, 4> ident { 'I', 'D', 'P', '2' };
inline constexpr int32_t version = 8;
inline constexpr size_t skin_name_size = 64, frame_name_size = 16;

struct Header {
    int32_t skin_width, skin_height;
    uint32_t frame_size; // bytes from one frame to the next
    uint32_t skin_count, vertex_count, coordinate_count, triangle_count;
    uint32_t command_count; // 32-bit words
    uint32_t frame_count;
    uint32_t skins, coordinates, triangles, frames, commands, end; // byte offsets
};
static_assert(sizeof(Header) == 60);

struct Coordinate {
    int16_t s, t; // texels
};
struct Triangle {
    uint16_t vertices[3], coordinates[3]; // clockwise seen from outside
};
struct FrameHeader {
    glm::vec3 scale, translate;
    std::array<char, frame_name_size> name;
};
struct Vertex {
    std::array<uint8_t, 3> position; // times scale, plus translate
    uint8_t normal;
};
static_assert(sizeof(Coordinate) == 4 && sizeof(Triangle) == 12 && sizeof(FrameHeader) == 40 && sizeof(Vertex) == 4);

// What the engine accepts.
inline constexpr size_t max_triangles = 4096, max_vertices = 2048, max_frames = 512, max_skins = 32;

// The directions that a vertex' normal is one of: an icosahedron's corners and those of its faces split in 16.
std::span<const glm::vec3, 162> normal_directions();
uint8_t nearest_direction(glm::vec3 normal);

} // namespace formats::md2_disk
