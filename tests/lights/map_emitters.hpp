// SPDX-License-Identifier: GPL-2.0-or-later
// Faces and emitters of a map whose textures are all alike.
#pragma once

#include "ref_vkpt/lights/emitters.hpp"

#include <vector>

namespace vkpt::test {

inline FaceTexture make_texture(glm::vec3 average)
{
    FaceTexture texture;
    texture.average = average;
    return texture;
}

struct MapFaces {
    explicit MapFaces(const formats::Bsp& bsp_, const FaceTexture& texture = {})
        : bsp(bsp_)
        , textures(bsp.texinfos.size(), texture)
        , triangles(bsp, textures)
    {
    }
    EmissionSource source(const EmissionScales& scales = {}) const { return { bsp, textures, scales }; }

    const formats::Bsp& bsp;
    std::vector<FaceTexture> textures; // per texinfo
    FaceTriangles triangles;
};

inline StaticEmitters extract_emitters(
    const formats::Bsp& bsp, const FaceTexture& texture, const EmissionScales& scales = {})
{
    MapFaces faces(bsp, texture);
    return extract_emitters(faces.source(scales), faces.triangles);
}

} // namespace vkpt::test
