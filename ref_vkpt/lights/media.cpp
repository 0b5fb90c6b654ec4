// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/media.hpp"

#include "ref_vkpt/lights/cluster_finder.hpp"

#include <algorithm>
#include <cctype>
#include <glm/common.hpp>
#include <limits>
#include <string>
#include <utility>

namespace vkpt {

namespace {

using formats::Bsp;

// So far from a face its sides are looked at.
constexpr float beside_face = 1;
// The light value of lava that has none: its radiance is then about that of its texture unlit.
constexpr int lava_value = 80;

uint32_t medium_of_name(std::string name)
{
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    if (name.find("lava") != std::string::npos)
        return shared::MEDIUM_LAVA;
    return name.find("slime") != std::string::npos ? shared::MEDIUM_SLIME : shared::MEDIUM_WATER;
}

float surface_of(const shared::FilterBox& box)
{
    const glm::vec3 size = box.maxs - box.mins;
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

shared::FilterBox unite(const shared::FilterBox& a, const shared::FilterBox& b)
{
    return { glm::min(a.mins, b.mins), glm::max(a.maxs, b.maxs) };
}

} // namespace

uint32_t medium_of_contents(uint32_t contents)
{
    if (contents & formats::CONTENTS_LAVA)
        return shared::MEDIUM_LAVA;
    if (contents & formats::CONTENTS_SLIME)
        return shared::MEDIUM_SLIME;
    return contents & formats::CONTENTS_WATER ? shared::MEDIUM_WATER : shared::MEDIUM_NONE;
}

uint32_t medium_at(const Bsp& bsp, glm::vec3 point, size_t model)
{
    const size_t leaf = bsp.find_leaf(point, model == 0 ? find_world_root(bsp) : bsp.models[model].head_node);
    return leaf < bsp.leaves.size() ? medium_of_contents(bsp.leaves[leaf].contents) : shared::MEDIUM_NONE;
}

uint32_t medium_of_face(const Bsp& bsp, size_t face, size_t model, uint32_t said)
{
    const formats::BspTexinfo& texinfo = bsp.texinfos[bsp.faces[face].texinfo];
    if (!(texinfo.flags & formats::SURF_WARP))
        return shared::MEDIUM_NONE;
    const glm::vec3 normal = bsp.face_normal(face), centre = face_centre(bsp, face);
    const uint32_t before = medium_at(bsp, centre + normal * beside_face, model),
                   behind = medium_at(bsp, centre - normal * beside_face, model);
    if (before != shared::MEDIUM_NONE && behind == shared::MEDIUM_NONE)
        return (said != shared::MEDIUM_NONE ? said : before) | shared::MEDIUM_IN_FRONT;
    if (behind != shared::MEDIUM_NONE && before == shared::MEDIUM_NONE)
        return said != shared::MEDIUM_NONE ? said : behind;
    const uint32_t medium = said != shared::MEDIUM_NONE ? said
        : behind != shared::MEDIUM_NONE                 ? behind
                                                        : medium_of_name(texinfo.texture);
    constexpr float looks_down = -0.5f;
    return normal.z < looks_down ? medium | shared::MEDIUM_IN_FRONT : medium;
}

std::vector<uint32_t> find_texinfo_media(const Bsp& bsp, std::span<const FaceTexture> textures)
{
    std::vector<uint32_t> media(bsp.texinfos.size(), shared::MEDIUM_NONE);
    for (size_t model = 0; model < bsp.models.size(); model++)
        for (int32_t i = 0; i < bsp.models[model].face_count; i++) {
            const size_t face = size_t(bsp.models[model].first_face + i);
            const uint32_t texinfo = bsp.faces[face].texinfo;
            const uint32_t said = texinfo < textures.size() ? textures[texinfo].medium : shared::MEDIUM_NONE;
            if (media[texinfo] == shared::MEDIUM_NONE)
                media[texinfo] = medium_of_face(bsp, face, model, said) & shared::MEDIUM_MASK;
        }
    return media;
}

void light_lava(Bsp& bsp, const std::vector<uint32_t>& texinfo_media)
{
    for (size_t i = 0; i < bsp.texinfos.size(); i++) {
        formats::BspTexinfo& texinfo = bsp.texinfos[i];
        if (texinfo_media[i] != shared::MEDIUM_LAVA)
            continue;
        // Nobody sees through lava, whatever the map says.
        texinfo.flags &= ~uint32_t(formats::SURF_TRANS33 | formats::SURF_TRANS66);
        if ((texinfo.flags & formats::SURF_LIGHT) && texinfo.value > 0)
            continue;
        texinfo.flags |= formats::SURF_LIGHT;
        texinfo.value = lava_value;
    }
}

void add_filter_box(std::vector<shared::FilterBox>& boxes, const shared::FilterBox& box)
{
    boxes.push_back(box);
    if (boxes.size() <= shared::MAX_FILTER_BOXES)
        return;
    std::pair<size_t, size_t> best { 0, 1 };
    float least = std::numeric_limits<float>::max();
    for (size_t a = 0; a < boxes.size(); a++)
        for (size_t b = a + 1; b < boxes.size(); b++) {
            const float growth = surface_of(unite(boxes[a], boxes[b])) - surface_of(boxes[a]) - surface_of(boxes[b]);
            if (growth < least) {
                least = growth;
                best = { a, b };
            }
        }
    boxes[best.first] = unite(boxes[best.first], boxes[best.second]);
    boxes.erase(boxes.begin() + long(best.second));
}

std::vector<shared::FilterBox> find_liquid_boxes(const Bsp& bsp)
{
    std::vector<shared::FilterBox> boxes;
    for (const formats::BspLeaf& leaf : bsp.leaves)
        if (medium_of_contents(leaf.contents) != shared::MEDIUM_NONE)
            add_filter_box(boxes,
                { glm::vec3(leaf.mins[0], leaf.mins[1], leaf.mins[2]),
                    glm::vec3(leaf.maxs[0], leaf.maxs[1], leaf.maxs[2]) });
    return boxes;
}

} // namespace vkpt
