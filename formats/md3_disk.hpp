// SPDX-License-Identifier: GPL-2.0-or-later
// How MD3 version 15 lies on disk.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace formats::md3_disk {

inline constexpr std::array<char, 4> ident { 'I', 'D', 'P', '3' }; // of the file, and of each surface
inline constexpr int32_t version = 15;
inline constexpr size_t path_size = 64, frame_name_size = 16;
inline constexpr float steps_per_unit = 64; // of positions

struct Header {
    std::array<char, path_size> name;
    uint32_t flags;
    uint32_t frame_count, tag_count, surface_count, skin_count;
    uint32_t frames, tags, surfaces, end; // byte offsets
};
struct Frame {
    glm::vec3 mins, maxs, origin;
    float radius;
    std::array<char, frame_name_size> name;
};
// Offsets are from the surface's own start; the next surface begins at `end`.
struct Surface {
    std::array<char, 4> ident;
    std::array<char, path_size> name;
    uint32_t flags;
    uint32_t frame_count, shader_count, vertex_count, triangle_count;
    uint32_t triangles, shaders, coordinates, vertices, end;
};
struct Shader {
    std::array<char, path_size> name;
    uint32_t number;
};
using Triangle = std::array<uint32_t, 3>; // clockwise seen from outside
using Coordinate = glm::vec2;
struct Vertex {
    std::array<int16_t, 3> position;
    uint8_t inclination, azimuth; // of the normal: from +z, and from +x in the plane below; 256 is a full turn
};
static_assert(sizeof(Header) == 100 && sizeof(Frame) == 56 && sizeof(Surface) == 108 && sizeof(Shader) == 68
    && sizeof(Triangle) == 12 && sizeof(Coordinate) == 8 && sizeof(Vertex) == 8);

// What Quake III accepts.
inline constexpr size_t max_frames = 1024, max_surfaces = 32, max_vertices = 4096, max_triangles = 8192;
inline constexpr size_t max_shaders = 32; // as many as Quake II chooses among; the format's own limit is 256

} // namespace formats::md3_disk
