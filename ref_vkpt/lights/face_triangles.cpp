// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/face_triangles.hpp"

#include "ref_vkpt/lights/back_to_back.hpp"
#include "ref_vkpt/lights/emitters.hpp"

#include <algorithm>
#include <numeric>

namespace vkpt {

namespace {

using namespace formats;

constexpr uint64_t max_triangles = 300'000; // per megabyte of the map; faces of many corners make 220,000

void append_triangles(
    std::vector<FaceTriangle>& triangles, const std::vector<glm::vec3>& outline, glm::vec3 normal, int part)
{
    for (const auto& [a, b, c] : triangulate(outline, normal))
        triangles.push_back({ { outline[a], outline[b], outline[c] }, part });
}

} // namespace

glm::vec3 face_centre(const Bsp& bsp, size_t face)
{
    const std::vector<glm::vec3> outline = bsp.face_polygon(face);
    const glm::vec3 sum = std::accumulate(outline.begin(), outline.end(), glm::vec3(0));
    return sum / std::max(1.0f, float(outline.size()));
}

bool is_drawn(const BspTexinfo& texinfo)
{
    return (texinfo.flags & (SURF_NODRAW | SURF_SKIP | SURF_HINT)) == 0 || (texinfo.flags & SURF_SKY) != 0;
}

FaceTriangles::FaceTriangles(const Bsp& bsp, std::span<const FaceTexture> textures)
{
    WorkLimit pieces = limit_of_pieces(bsp), triangles(bsp, max_triangles, "triangles");
    const std::vector<bool> back_to_back = find_back_to_back(bsp);
    first_.push_back(0);
    for (size_t face = 0; face < bsp.faces.size(); face++) {
        const BspTexinfo& texinfo = bsp.texinfos[bsp.faces[face].texinfo];
        const FaceTexture& texture = textures[bsp.faces[face].texinfo];
        const glm::vec3 normal = bsp.face_normal(face);
        if (has_light_value(texinfo) || is_glowing(texinfo, texture))
            if (texinfo.next < 0) // an animation's textures shine in different places
                for (const FacePiece& piece : cut_face(bsp, face, texture.parts, texture.size, pieces))
                    append_triangles(triangles_, piece.outline, normal, piece.part);
        if (triangles_.size() == first_.back() && (is_drawn(texinfo) || has_light_value(texinfo)))
            append_triangles(triangles_, bsp.face_polygon(face), normal, FaceTriangle::whole);
        if (back_to_back[face])
            for (size_t i = first_.back(); i < triangles_.size(); i++)
                for (glm::vec3& corner : triangles_[i].corners)
                    corner += normal * side_lift;
        triangles.spend(triangles_.size() - first_.back(), "face", face);
        first_.push_back(uint32_t(triangles_.size()));
    }
}

} // namespace vkpt
