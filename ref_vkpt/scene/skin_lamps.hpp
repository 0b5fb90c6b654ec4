// SPDX-License-Identifier: GPL-2.0-or-later
// Which triangles of a model are lamps: those whose skin glows.
#pragma once

#include "formats/image.hpp"
#include "ref_vkpt/scene/md2_mesh.hpp"

#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <vector>

namespace vkpt {

// Texels of an emissive map, with sides of at most `glow_map_size`.
using GlowMap = std::shared_ptr<const formats::Image>;
inline constexpr int glow_map_size = 128;
GlowMap make_glow_map(const formats::Image& emissive);

struct SkinLamp {
    uint32_t slot; // of the mesh's triangle, as in Md2Mesh::corners
    glm::vec3 colour; // mean of the map over the triangle, linear
};
// The most powerful ones first.
using SkinLamps = std::vector<SkinLamp>;

// A model has so many lamps at most: bounce rays find what else of it glows.
inline constexpr size_t max_skin_lamps = 16;

// By their areas in the mesh's first frame. Empty: nothing of it glows.
SkinLamps find_skin_lamps(const Md2Mesh& mesh, const formats::Image& glow);

// Finds each pair of mesh and map once.
class SkinLampCache {
public:
    // nullptr: nothing glows.
    std::shared_ptr<const SkinLamps> find(const std::shared_ptr<const Md2Mesh>& mesh, const GlowMap& glow);
    void clear() { known_.clear(); }

private:
    // Both are kept, so that no other has their addresses.
    std::map<std::pair<std::shared_ptr<const Md2Mesh>, GlowMap>, std::shared_ptr<const SkinLamps>> known_;
};

} // namespace vkpt
