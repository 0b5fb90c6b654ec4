// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/material_commands.hpp"

#include "formats/material_file.hpp"
#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/files/output_folder.hpp"
#include "ref_vkpt/material_inspector.hpp"
#include "ref_vkpt/module.hpp"

#include <algorithm>
#include <optional>

namespace vkpt {

namespace {

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

void edit_material(Module& m, const PickedMaterial& picked, std::string_view attribute, std::string_view value)
{
    const formats::AttributeRow* row = formats::find_attribute(attribute);
    if (!row || !formats::is_attribute_value(*row, value)) {
        engine::print("mat: \"{} {}\" says nothing of a material; attributes are", attribute, value);
        return print_attributes();
    }
    AttributeEffect effect = effect_of(*row, value);
    if (effect == AttributeEffect::of_walls_with_next_map && !picked.texinfo)
        effect = AttributeEffect::at_once;
    m.scene.materials().edit(picked.name, attribute, value);
    m.renew_scene();
    engine::print("{}: {} {}{}; `mat save` keeps it", picked.name, attribute, value, describe(effect));
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

void reset_material(Module& m, const std::string& name)
{
    const bool is_late = has_late_edits(m.scene.materials(), name);
    for (const formats::AttributeRow& row : formats::material_attributes())
        m.scene.materials().edit(name, row.name, "");
    m.renew_scene();
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

void run_material_command(Module& m)
{
    const std::string_view word = engine::argument(1);
    if (word == "save")
        return save_materials(m);
    const std::optional<PickedMaterial> picked = pick_material(m);
    if (!picked)
        return engine::print("mat: no surface of the map or of a model is under the crosshair");
    if (word == "reset")
        return reset_material(m, picked->name);
    if (engine::argument_count() == 3)
        return edit_material(m, *picked, word, engine::argument(2));
    if (engine::argument_count() > 1)
        return engine::print("usage: mat, mat ATTRIBUTE VALUE, mat reset, mat save");
    for (const std::string& line : describe_material(m, *picked))
        engine::print("{}", line);
}

} // namespace vkpt
