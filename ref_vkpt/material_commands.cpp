// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/material_commands.hpp"

#include "formats/material_file.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/files/output_folder.hpp"
#include "ref_vkpt/module.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

namespace vkpt {

namespace {

// Distance to a triangle, both of whose sides are met (Moeller and Trumbore 1997).
std::optional<float> meet_triangle(const shared::Triangle& triangle, glm::vec3 origin, glm::vec3 direction)
{
    const glm::vec3 p = triangle.positions[0], e1 = triangle.positions[1] - p, e2 = triangle.positions[2] - p;
    const glm::vec3 across = glm::cross(direction, e2);
    const float determinant = glm::dot(e1, across);
    if (determinant == 0)
        return std::nullopt;
    const glm::vec3 offset = origin - p, other = glm::cross(offset, e1);
    const float u = glm::dot(offset, across) / determinant, v = glm::dot(direction, other) / determinant,
                t = glm::dot(e2, other) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? std::optional(t) : std::nullopt;
}

void print_material(const Module& m, uint32_t texinfo)
{
    const World& world = *m.scene.world();
    const std::string& name = world.material_names[texinfo];
    const shared::Material& material = m.view().snapshot->materials[texinfo];
    engine::print("{}: roughness {:.2f}{}, metalness {:.2f}{}{}", name, material.roughness,
        material.flags & shared::MATERIAL_ROUGHNESS_IN_ALPHA ? " at least, by its alpha" : "", material.metallic,
        material.flags & shared::MATERIAL_METALNESS_IN_ALPHA ? " times its normal map's alpha" : "",
        (material.maps & 0xffff) != 0 ? ", with a normal map" : "");
    if (const MaterialSettings* settings = m.scene.materials().find(name))
        for (const auto& [attribute, value] : settings->attributes)
            engine::print("    {} {}", attribute, value);
}

using formats::AttributeEffect;

std::string_view describe(AttributeEffect effect)
{
    switch (effect) {
    case AttributeEffect::of_walls_with_next_map:
        return "; of walls, it counts with the next map";
    case AttributeEffect::with_next_map:
        return "; it counts with the next map";
    case AttributeEffect::none:
        return "; it has no effect here";
    case AttributeEffect::at_once:
        break;
    }
    return "";
}

void print_attributes()
{
    for (const formats::AttributeRow& row : formats::material_attributes())
        engine::print("    {}: {}{}", row.name, row.purpose, describe(row.effect));
}

void edit_material(Module& m, uint32_t texinfo, std::string_view attribute, std::string_view value)
{
    const formats::AttributeRow* row = formats::find_attribute(attribute);
    if (!row || !formats::is_attribute_value(*row, value)) {
        engine::print("mat: \"{} {}\" says nothing of a material; attributes are", attribute, value);
        return print_attributes();
    }
    const std::string& name = m.scene.world()->material_names[texinfo];
    m.scene.materials().edit(name, attribute, value);
    engine::print("{}: {} {}{}; `mat save` keeps it", name, attribute, value, describe(effect_of(*row, value)));
}

// Whether the player has changed what a map that is there does not show.
bool has_late_edits(const MaterialLibrary& materials, const std::string& name)
{
    const auto is_late = [](const auto& attribute) {
        const AttributeEffect effect = effect_of(*formats::find_attribute(attribute.first), attribute.second);
        return effect == AttributeEffect::with_next_map || effect == AttributeEffect::of_walls_with_next_map;
    };
    return std::ranges::any_of(materials.edits(), [&](const formats::MaterialEntry& entry) {
        return entry.names.front() == name && std::ranges::any_of(entry.attributes, is_late);
    });
}

void reset_material(Module& m, uint32_t texinfo)
{
    const std::string& name = m.scene.world()->material_names[texinfo];
    const bool is_late = has_late_edits(m.scene.materials(), name);
    for (const formats::AttributeRow& row : formats::material_attributes())
        m.scene.materials().edit(name, row.name, "");
    engine::print("{}: as the game's files say{}", name, is_late ? "; some of it counts with the next map" : "");
}

void save_materials(const Module& m)
{
    const std::string text = std::string(saved_materials_head) + formats::write_materials(m.scene.materials().edits());
    try {
        const OutputFolder folder(engine::game_directory(), { "vkpt" });
        folder.write("materials.mat", std::as_bytes(std::span(text)), saved_materials_head);
        engine::print("ref_vkpt: wrote {}", (folder.path() / "materials.mat").string());
    } catch (const FileError& error) {
        engine::print("ref_vkpt: {}", error.what());
    }
}

} // namespace

std::optional<uint32_t> find_texinfo(const World& world, glm::vec3 origin, glm::vec3 direction)
{
    float nearest = std::numeric_limits<float>::max();
    std::optional<uint32_t> texinfo;
    for (const shared::Triangle& triangle : world.models[0].triangles)
        if (const std::optional<float> t = meet_triangle(triangle, origin, direction); t && *t < nearest) {
            nearest = *t;
            texinfo = triangle.material;
        }
    return texinfo;
}

void run_material_command(Module& m)
{
    const std::string_view word = engine::argument(1);
    if (word == "save")
        return save_materials(m);
    const World* world = m.scene.world();
    const std::optional<uint32_t> texinfo = world && m.view().snapshot && m.last_camera
        ? find_texinfo(*world, m.last_camera->eye, m.last_camera->forward)
        : std::nullopt;
    if (!texinfo)
        return engine::print("mat: no face of the map is under the crosshair");
    if (word == "reset")
        return reset_material(m, *texinfo);
    if (engine::argument_count() == 3)
        return edit_material(m, *texinfo, word, engine::argument(2));
    if (engine::argument_count() > 1)
        return engine::print("usage: mat, mat ATTRIBUTE VALUE, mat reset, mat save");
    print_material(m, *texinfo);
}

} // namespace vkpt
