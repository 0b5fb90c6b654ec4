// SPDX-License-Identifier: GPL-2.0-or-later
// IQM (Inter-Quake Model) version 2: meshes that a skeleton moves. read_iqm (formats/model.hpp) applies the skeleton,
// so that the renderer meets vertex frames as of an MD2; this is the model as the file has it, for writers. Source: the
// format's iqm.txt by Lee Salzman.
#pragma once

#include "formats/byte_reader.hpp"

#include <array>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace formats {

struct IqmModel {
    // A joint in its parent's space: a point is scaled, then rotated, then translated.
    struct Placing {
        glm::vec3 translation { 0 };
        glm::quat rotation { 1, 0, 0, 0 }; // w first
        glm::vec3 scale { 1 };
    };
    struct Joint {
        std::string name;
        int32_t parent = -1; // a joint before this one; -1 none
        Placing bind; // where the vertices were fixed to it
    };
    struct Vertex {
        glm::vec3 position { 0 }, normal { 0, 0, 1 };
        glm::vec2 texture_coordinate { 0 };
        std::array<uint8_t, 4> joints {}, weights {}; // weights add up to 255; all 0: it does not move
    };
    struct Mesh {
        std::string name;
        std::string material; // the skin's file name without folder and ending, beside the model: Q2RTX
        std::vector<Vertex> vertices;
        std::vector<uint32_t> indices; // three a triangle, of `vertices`, counter-clockwise seen from outside
    };
    std::vector<Mesh> meshes;
    std::vector<Joint> joints;
    std::vector<std::vector<Placing>> frames; // each with a placing for each joint; none: the bind pose
};

bool is_iqm(Bytes file); // by its first bytes
// Positions and scales of frames are kept to 1/65535 of the range that they move in. Throws std::invalid_argument.
std::vector<std::byte> write_iqm(const IqmModel& model);

} // namespace formats
