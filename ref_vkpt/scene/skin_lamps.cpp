// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/skin_lamps.hpp"

#include "common/colour.hpp"
#include "ref_vkpt/lights/face_pieces.hpp"
#include "ref_vkpt/scene/texture_files.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace vkpt {

namespace {

// `place`: in texels; the map repeats.
glm::vec3 read_texel(const formats::Image& map, glm::vec2 place)
{
    const auto wrap = [](float x, int size) {
        const int cell = int(std::floor(x - std::floor(x / float(size)) * float(size)));
        return std::clamp(cell, 0, size - 1);
    };
    const int x = wrap(place.x, map.width), y = wrap(place.y, map.height);
    return decode_colour(map.pixels[size_t(y) * size_t(map.width) + size_t(x)]);
}

// Over `rows` x `rows` equal parts of the triangle, one for each texel along its longest side.
glm::vec3 mean_over(const formats::Image& map, const std::array<glm::vec2, 3>& uvs)
{
    constexpr float least = 2, most = 48;
    const glm::vec2 size(map.width, map.height);
    const glm::vec2 a = uvs[0] * size, across = uvs[1] * size - a, down = uvs[2] * size - a;
    const float longest = std::max({ glm::length(across), glm::length(down), glm::length(across - down) });
    if (!(longest < 1e6f)) // NaN, too
        return glm::vec3(0);
    const int rows = int(std::clamp(std::ceil(longest), least, most));
    glm::vec3 sum(0);
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < rows; j++) { // the parts beyond the third side are turned around its middle
            glm::vec2 b((float(i) + 0.5f) / float(rows), (float(j) + 0.5f) / float(rows));
            if (b.x + b.y > 1)
                b = 1.0f - b;
            sum += read_texel(map, a + across * b.x + down * b.y);
        }
    return sum / float(rows * rows);
}

} // namespace

GlowMap make_glow_map(const formats::Image& emissive)
{
    formats::Image map = emissive;
    while (std::max(map.width, map.height) > glow_map_size)
        map = halve_texture(map);
    return std::make_shared<const formats::Image>(std::move(map));
}

SkinLamps find_skin_lamps(const Md2Mesh& mesh, const formats::Image& glow)
{
    constexpr float darkest = 1e-3f;
    const Md2Pose first_frame;
    std::vector<Float4> points;
    if (!mesh.can_pose(first_frame) || glow.width < 1 || glow.height < 1)
        return {};
    mesh.pose(first_frame, points);
    struct Candidate {
        SkinLamp lamp;
        float power;
    };
    std::vector<Candidate> candidates;
    for (uint32_t slot = 0; slot < mesh.triangle_count(); slot++) {
        const SkinLamp lamp { slot, mean_over(glow, mesh.uvs()[slot]) };
        const uint32_t* corners = &mesh.corners()[size_t(slot) * 3];
        const float area
            = triangle_area(to_vec3(points[corners[0]]), to_vec3(points[corners[1]]), to_vec3(points[corners[2]]));
        if (luminance(lamp.colour) > darkest && area > 0)
            candidates.push_back({ lamp, luminance(lamp.colour) * area });
    }
    std::ranges::stable_sort(candidates, std::greater {}, &Candidate::power);
    candidates.resize(std::min(candidates.size(), max_skin_lamps));
    SkinLamps lamps;
    for (const Candidate& candidate : candidates)
        lamps.push_back(candidate.lamp);
    return lamps;
}

std::shared_ptr<const SkinLamps> SkinLampCache::find(const std::shared_ptr<const Md2Mesh>& mesh, const GlowMap& glow)
{
    if (!glow)
        return nullptr;
    const auto [entry, is_new] = known_.try_emplace({ mesh, glow });
    if (is_new)
        if (SkinLamps lamps = find_skin_lamps(*mesh, *glow); !lamps.empty())
            entry->second = std::make_shared<const SkinLamps>(std::move(lamps));
    return entry->second;
}

} // namespace vkpt
