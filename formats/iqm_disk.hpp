// SPDX-License-Identifier: GPL-2.0-or-later
// How IQM version 2 lies on disk. Offsets are from the file's start.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace formats::iqm_disk {

inline constexpr std::array<char, 16> magic { 'I', 'N', 'T', 'E', 'R', 'Q', 'U', 'A', 'K', 'E', 'M', 'O', 'D', 'E', 'L',
    0 };
inline constexpr uint32_t version = 2;

// Behind the magic and the version.
struct Header {
    uint32_t file_size, flags;
    uint32_t text_size, text;
    uint32_t mesh_count, meshes;
    uint32_t array_count, vertex_count, arrays;
    uint32_t triangle_count, triangles, adjacency;
    uint32_t joint_count, joints;
    uint32_t pose_count, poses;
    uint32_t animation_count, animations;
    uint32_t frame_count, channel_count, frames, bounds; // channels of a frame: 16-bit numbers
    uint32_t comment_size, comment;
    uint32_t extension_count, extensions;
};
struct Mesh {
    uint32_t name, material; // places in the text
    uint32_t first_vertex, vertex_count;
    uint32_t first_triangle, triangle_count;
};
enum ArrayType : uint32_t { Position, TextureCoordinate, Normal, Tangent, BlendIndices, BlendWeights, TypeCount };
enum ArrayFormat : uint32_t { UnsignedByte = 1, Int = 4, UnsignedInt = 5, Float = 7 };
struct VertexArray {
    uint32_t type, flags, format;
    uint32_t size; // numbers for each vertex
    uint32_t offset;
};
using Triangle = std::array<uint32_t, 3>; // clockwise seen from outside; vertices of the whole file
struct Joint {
    uint32_t name;
    int32_t parent; // < 0: none
    glm::vec3 translation;
    glm::vec4 rotation; // x, y, z, w
    glm::vec3 scale;
};
// Translation, rotation (x, y, z, w) and scale: offset + scale * number of the frame where the mask has the channel's
// bit.
inline constexpr size_t channels = 10;
struct Pose {
    int32_t parent;
    uint32_t mask;
    std::array<float, channels> offset, scale;
};
static_assert(sizeof(Header) == 104 && sizeof(Mesh) == 24 && sizeof(VertexArray) == 20 && sizeof(Triangle) == 12);
static_assert(sizeof(Joint) == 48 && sizeof(Pose) == 88);
inline constexpr size_t header_at = sizeof(magic) + sizeof(version);

// What Q2RTX and ioquake3 accept of joints; the others bound what a small file can stand for.
inline constexpr size_t max_joints = 256, max_meshes = 32, max_frames = 4096;
inline constexpr size_t max_name_size = 64;

} // namespace formats::iqm_disk
