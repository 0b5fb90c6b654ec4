// SPDX-License-Identifier: GPL-2.0-or-later
// Faces cut along the parts of their texture that shine: a lamp in a dark panel lights the room from where the lamp is.
#pragma once

#include "formats/bsp.hpp"
#include "ref_vkpt/lights/work_limit.hpp"

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace vkpt {

// A rectangle of a texture that is much brighter than the rest.
struct BrightPart {
    glm::vec2 mins, maxs; // (0, 0) .. (1, 1): the whole texture
    glm::vec3 average; // linear RGB
};

// The cut of a face in one outline: corners in Bsp::face_polygon's order.
struct FacePiece {
    static constexpr int dark = -1;
    std::vector<glm::vec3> outline;
    int part; // index of the part that it shows, or `dark`
};

// Cuts bsp.face_polygon(face) along the parts' edges, the texture being `size` texels wide and high in texinfo space
// and tiled. Empty where the face shows no bright part, or so many that it may as well shine as a whole. `work` is what
// all faces of the map may take together: see limit_of_pieces.
std::vector<FacePiece> cut_face(
    const formats::Bsp& bsp, size_t face, const std::vector<BrightPart>& parts, glm::ivec2 size, WorkLimit& work);
WorkLimit limit_of_pieces(const formats::Bsp& bsp);

inline float triangle_area(glm::vec3 a, glm::vec3 b, glm::vec3 c)
{
    return 0.5f * glm::length(glm::cross(b - a, c - a));
}
// The area of a convex outline.
float measure_area(const std::vector<glm::vec3>& outline);

} // namespace vkpt
