// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/calibrate_light/luxels.hpp"

#include "common/colour.hpp"
#include "formats/entities.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <random>

namespace vkpt::tools {

namespace {

using formats::Bsp;

constexpr float luxel_size = 16; // texels
constexpr float lightmap_unit = 128; // the value under which a white diffuse surface has radiance 1
constexpr uint8_t clipped_value = 190; // compilers scale brighter samples down to 196: those say only "at least"
constexpr float min_value = 6; // luminance; below, rounding to integers is more than 8 %
constexpr float edge_margin = 1; // units inside of the face's edges
constexpr float clearance = 1; // units in front of the face that must be open

// Solves "texture coordinates = st, on the face's plane".
class LuxelFrame {
public:
    LuxelFrame(const Bsp& bsp, size_t face)
        : texinfo_(bsp.texinfos[bsp.faces[face].texinfo])
        , plane_(bsp.planes[bsp.faces[face].plane])
    {
        const glm::mat3 rows = glm::transpose(glm::mat3(texinfo_.s_axis, texinfo_.t_axis, plane_.normal));
        const float size = glm::length(texinfo_.s_axis) * glm::length(texinfo_.t_axis);
        if (std::abs(glm::determinant(rows)) > 1e-4f * size)
            inverse_ = glm::inverse(rows);
    }

    bool is_solvable() const { return inverse_.has_value(); }
    glm::vec3 find_position(glm::vec2 st) const
    {
        return *inverse_ * glm::vec3(st.x - texinfo_.s_offset, st.y - texinfo_.t_offset, plane_.dist);
    }

private:
    const formats::BspTexinfo& texinfo_;
    const formats::BspPlane& plane_;
    std::optional<glm::mat3> inverse_;
};

bool is_inside(const std::vector<glm::vec3>& outline, glm::vec3 normal, glm::vec3 p)
{
    float turn = 0; // outlines may run either way
    for (size_t i = 0; i < outline.size(); i++)
        turn += glm::dot(glm::cross(outline[i] - outline[0], outline[(i + 1) % outline.size()] - outline[0]), normal);
    for (size_t i = 0; i < outline.size(); i++) {
        const glm::vec3 edge = outline[(i + 1) % outline.size()] - outline[i];
        const float length = glm::length(edge);
        if (length < 1e-3f)
            continue;
        const float inwards = glm::dot(glm::cross(normal, edge / length), p - outline[i]);
        if ((turn < 0 ? -inwards : inwards) < edge_margin)
            return false;
    }
    return true;
}

bool is_open(const Bsp& bsp, glm::vec3 p)
{
    const formats::BspLeaf& leaf = bsp.leaves[bsp.find_leaf(p, bsp.models.empty() ? 0 : bsp.models[0].head_node)];
    return !(leaf.contents & formats::CONTENTS_SOLID);
}

// Where the lightmap of lightstyle 0 begins among the face's lightmaps; nothing where the face has none.
std::optional<size_t> find_steady_lightmap(const Bsp& bsp, size_t face, glm::ivec2 size)
{
    const formats::BspFace& f = bsp.faces[face];
    const size_t bytes = 3 * size_t(size.x) * size_t(size.y);
    if (f.light_offset < 0 || bytes == 0)
        return std::nullopt;
    for (size_t i = 0; i < std::size(f.styles) && f.styles[i] != 255; i++) {
        const size_t first = size_t(f.light_offset) + i * bytes;
        if (f.styles[i] == 0 && first + bytes <= bsp.lighting.size())
            return first;
    }
    return std::nullopt;
}

// What a compiler added to every lightmap, whatever shines there: worldspawn's keys. It comes from no light.
float find_ambient(const Bsp& bsp)
{
    for (const formats::EntityText& entity : formats::parse_entities(bsp.entity_text, bsp.name))
        if (entity.class_name() == "worldspawn")
            return std::max(0.0f, entity.number("light", entity.number("_minlight", 0)))
                + std::max(0.0f, entity.number("_sun_ambient", 0));
    return 0;
}

// Nothing where it is clipped or too dark.
std::optional<glm::vec3> read_baked(const Bsp& bsp, size_t offset, float ambient)
{
    const uint8_t* rgb = bsp.lighting.data() + offset;
    const glm::vec3 value = glm::vec3(rgb[0], rgb[1], rgb[2]) - ambient;
    if (std::max({ rgb[0], rgb[1], rgb[2] }) >= clipped_value || luminance(value) < min_value)
        return std::nullopt;
    return value / lightmap_unit;
}

void collect_face(const Bsp& bsp, size_t face, float ambient, std::vector<Luxel>& luxels)
{
    const uint32_t flags = bsp.texinfos[bsp.faces[face].texinfo].flags;
    if (flags & (formats::SURF_SKY | formats::SURF_WARP | formats::SURF_NODRAW | formats::SURF_LIGHT))
        return;
    const Bsp::LightmapExtent extent = bsp.lightmap_extent(face);
    const std::optional<size_t> lightmap = find_steady_lightmap(bsp, face, extent.size);
    const LuxelFrame frame(bsp, face);
    if (!lightmap || !frame.is_solvable())
        return;
    const std::vector<glm::vec3> outline = bsp.face_polygon(face);
    const glm::vec3 normal = bsp.face_normal(face);
    for (int y = 0; y < extent.size.y; y++)
        for (int x = 0; x < extent.size.x; x++) {
            const std::optional<glm::vec3> baked
                = read_baked(bsp, *lightmap + 3 * (size_t(y) * size_t(extent.size.x) + size_t(x)), ambient);
            const glm::vec3 position = frame.find_position(extent.min_st + luxel_size * glm::vec2(x, y));
            if (baked && is_inside(outline, normal, position) && is_open(bsp, position + clearance * normal))
                luxels.push_back({ face, position, normal, *baked });
        }
}

} // namespace

std::vector<Luxel> collect_luxels(const Bsp& bsp)
{
    std::vector<Luxel> luxels;
    if (bsp.models.empty())
        return luxels;
    const float ambient = find_ambient(bsp);
    for (int32_t i = 0; i < bsp.models[0].face_count; i++)
        collect_face(bsp, size_t(bsp.models[0].first_face + i), ambient, luxels);
    return luxels;
}

std::vector<Luxel> choose_luxels(std::vector<Luxel> luxels, size_t count, uint32_t seed)
{
    std::mt19937 rng(seed);
    for (size_t i = 0; i < std::min(count, luxels.size()); i++)
        std::swap(luxels[i], luxels[i + rng() % (luxels.size() - i)]);
    if (luxels.size() > count)
        luxels.resize(count);
    return luxels;
}

} // namespace vkpt::tools
