// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/lightmaps.hpp"

#include "ref_vkpt/scene/world.hpp"

#include <algorithm>

namespace vkpt {

namespace {

constexpr float luxel_size = 16; // texels
constexpr uint8_t no_style = 255;
constexpr int max_size = 0xffff; // of a face's lightmap, see LightmapFace::size

uint32_t count_styles(const formats::BspFace& face)
{
    uint32_t count = 0;
    while (count < 4 && face.styles[count] != no_style)
        count++;
    return count;
}

} // namespace

Lightmaps read_lightmaps(const World& world)
{
    const formats::Bsp& bsp = world.bsp;
    constexpr size_t bytes_each = 3;
    const size_t max_luxels = bsp.lighting.size() / bytes_each + 1; // each byte is some face's
    Lightmaps maps;
    maps.luxels.assign(1, 0);
    for (size_t i = 0; i < bsp.faces.size(); i++) {
        const formats::BspFace& face = bsp.faces[i];
        const formats::Bsp::LightmapExtent extent = bsp.lightmap_extent(i);
        shared::LightmapFace map {};
        const size_t luxels = size_t(extent.size.x) * size_t(extent.size.y) * count_styles(face);
        const size_t first = face.light_offset >= 0 ? size_t(face.light_offset) : bsp.lighting.size();
        const bool is_there = luxels > 0 && std::max(extent.size.x, extent.size.y) <= max_size
            && first + luxels * bytes_each <= bsp.lighting.size() && maps.luxels.size() + luxels <= max_luxels;
        if (is_there) {
            map.scale = glm::vec2(world.textures[face.texinfo].size) / luxel_size;
            map.offset = -glm::vec2(extent.min_st) / luxel_size;
            map.first = uint32_t(maps.luxels.size());
            map.size = uint32_t(extent.size.x) | uint32_t(extent.size.y) << 16;
            for (int style = 0; style < 4; style++)
                map.styles |= uint32_t(face.styles[style]) << (8 * style);
            for (size_t luxel = 0; luxel < luxels; luxel++) {
                const uint8_t* rgb = &bsp.lighting[first + luxel * bytes_each];
                maps.luxels.push_back(uint32_t(rgb[0]) | uint32_t(rgb[1]) << 8 | uint32_t(rgb[2]) << 16);
            }
        }
        maps.faces.push_back(map);
    }
    return maps;
}

} // namespace vkpt
