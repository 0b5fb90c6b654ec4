// SPDX-License-Identifier: GPL-2.0-or-later
// MD2 and MD3 (key-framed triangle meshes), IQM (meshes on a skeleton), and SP2 (sprites).
#pragma once

#include "formats/byte_reader.hpp"

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

namespace formats {

// One mesh, of an MD2, a surface of an MD3 or a mesh of an IQM: corners are (position index, texture coordinate) pairs
// made unique, so one index buffer serves all frames.
struct Md2Model {
    struct Frame {
        std::string name;
        std::vector<glm::vec3> positions; // one per vertex, model space
        std::vector<glm::vec3> normals; // unit, of an MD2 from a table of 162 directions
        glm::vec3 mins { 0 },
            maxs { 0 }; // hold all positions, with room to spare; write_md2 finds them where they do not
    };
    int skin_width = 0, skin_height = 0;
    std::vector<std::string> skins; // paths as stored
    std::vector<glm::vec2> texture_coordinates; // one per vertex, 0..1
    std::vector<uint32_t> indices; // three per triangle, counter-clockwise seen from outside
    std::vector<Frame> frames; // at least one
    size_t vertex_count() const { return texture_coordinates.size(); }
    size_t triangle_count() const { return indices.size() / 3; }
};

struct Sp2Sprite {
    struct Frame {
        int width = 0, height = 0;
        int origin_x = 0, origin_y = 0; // from the lower left corner to the sprite's origin
        std::string picture;
    };
    std::vector<Frame> frames;
};

Md2Model read_md2(Bytes file, std::string_view name);
// A mesh for each surface; all have the same frames. Tags and flags are left out.
std::vector<Md2Model> read_md3(Bytes file, std::string_view name);
// A mesh for each of the file's; the skeleton has been applied to the vertices of every frame. formats/model_iqm.hpp
std::vector<Md2Model> read_iqm(Bytes file, std::string_view name);
// Any of them. An IQM is known by its content, as Q2RTX does, an MD3 by its name's ending.
std::vector<Md2Model> read_mesh(Bytes file, std::string_view name);
// What is shown in place of NAME.md2 where the folder has it, best first: NAME.md3, as in other renderers, and
// NAME.iqm. Empty: the name is not that of an MD2.
std::vector<std::string> replacements_of_mesh(std::string_view name);
Sp2Sprite read_sp2(Bytes file, std::string_view name);
std::vector<std::byte> write_md2(const Md2Model& model);
std::vector<std::byte> write_md3(std::span<const Md2Model> surfaces);
std::vector<std::byte> write_sp2(const Sp2Sprite& sprite);

} // namespace formats
