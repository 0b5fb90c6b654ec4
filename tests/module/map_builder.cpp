// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/module/map_builder.hpp"

#include "tests/lights/synthetic_bsp.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace vkpt::tests {

Polygon rectangle(glm::vec3 centre, glm::vec3 half_a, glm::vec3 half_b)
{
    return { centre - half_a - half_b, centre + half_a - half_b, centre + half_a + half_b, centre - half_a + half_b };
}

MapBuilder::MapBuilder()
{
    constexpr float bound = 4096;
    bsp_.edges.push_back({});
    formats::BspLeaf leaf {};
    std::ranges::fill(leaf.mins, -bound);
    std::ranges::fill(leaf.maxs, bound);
    bsp_.leaves.push_back(leaf);
    bsp_.models.push_back({ glm::vec3(-bound), glm::vec3(bound), glm::vec3(0), -1, 0, 0 });
    add_entity({ { "classname", "worldspawn" } });
    // One cluster: its count, where its two rows stand, and the row.
    bsp_.cluster_count = 1;
    const int32_t visibility[] = { 1, 12, 12, 1 };
    bsp_.visibility.resize(sizeof visibility);
    std::memcpy(bsp_.visibility.data(), visibility, sizeof visibility);
}

uint16_t MapBuilder::add_material(const std::string& texture, uint32_t flags, int value)
{
    formats::BspTexinfo texinfo {};
    texinfo.s_axis = glm::vec3(1, 0, 0);
    texinfo.t_axis = glm::vec3(0, -1, 0);
    texinfo.flags = flags | (value > 0 ? uint32_t(formats::SURF_LIGHT) : 0);
    texinfo.value = value;
    texinfo.texture = texture;
    texinfo.next = -1;
    bsp_.texinfos.push_back(texinfo);
    return uint16_t(bsp_.texinfos.size() - 1);
}

void MapBuilder::add(const Polygon& polygon, uint16_t material)
{
    const glm::vec3 normal = glm::normalize(glm::cross(polygon[1] - polygon[0], polygon[2] - polygon[0]));
    const size_t face = test::add_face(bsp_, polygon, normal, material);
    std::ranges::fill(bsp_.faces[face].styles, uint8_t(255));
    bsp_.models.back().face_count++;
}

void MapBuilder::add_box(glm::vec3 mins, glm::vec3 maxs, uint16_t material, bool inwards)
{
    const glm::vec3 centre = (mins + maxs) * 0.5f, half = (maxs - mins) * 0.5f;
    for (int axis = 0; axis < 3; axis++)
        for (const float side : { -1.0f, 1.0f }) {
            glm::vec3 a(0), b(0), offset(0);
            a[(axis + 1) % 3] = half[(axis + 1) % 3];
            b[(axis + 2) % 3] = half[(axis + 2) % 3];
            offset[axis] = side * half[axis];
            // cross(a, b) points along +axis.
            const bool is_along = (side > 0) != inwards;
            add(rectangle(centre + offset, is_along ? a : b, is_along ? b : a), material);
        }
}

void MapBuilder::add_room(glm::vec3 mins, glm::vec3 maxs, uint16_t material) { add_box(mins, maxs, material, true); }

void MapBuilder::add_block(glm::vec3 mins, glm::vec3 maxs, uint16_t material) { add_box(mins, maxs, material, false); }

void MapBuilder::begin_brush_model()
{
    formats::BspModel model = bsp_.models.front();
    model.first_face = int32_t(bsp_.faces.size());
    model.face_count = 0;
    bsp_.models.push_back(model);
}

void MapBuilder::add_entity(const Pairs& pairs)
{
    bsp_.entity_text += "{\n";
    for (const auto& [key, value] : pairs)
        bsp_.entity_text += fmt::format("\"{}\" \"{}\"\n", key, value);
    bsp_.entity_text += "}\n";
}

void MapBuilder::add_lit_room(const std::string& wall)
{
    add_room({ -128, -128, 0 }, { 128, 128, 128 }, add_material(wall));
    add(rectangle({ 0, 0, 127 }, { 0, 16, 0 }, { 16, 0, 0 }), add_material("lamp", 0, 1000));
}

void MapBuilder::add_point_light(glm::vec3 origin, float light, int style)
{
    add_entity({ { "classname", "light" }, { "origin", fmt::format("{} {} {}", origin.x, origin.y, origin.z) },
        { "light", fmt::format("{}", light) }, { "style", fmt::format("{}", style) } });
}

formats::Bsp MapBuilder::finish()
{
    formats::Bsp bsp = bsp_;
    for (size_t face = 0; face < size_t(bsp.models[0].face_count); face++)
        bsp.leaf_faces.push_back(uint32_t(face));
    bsp.leaves[0].leaf_face_count = uint32_t(bsp.leaf_faces.size());
    return bsp;
}

} // namespace vkpt::tests
