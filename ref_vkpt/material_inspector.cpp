// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/material_inspector.hpp"

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/module.hpp"
#include "ref_vkpt/overlay/wrap_line.hpp"
#include "ref_vkpt/scene/material_guess.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vkpt {

namespace {

constexpr std::chrono::milliseconds between_picks { 250 };

std::string_view name_of_medium(uint32_t medium)
{
    switch (medium) {
    case shared::MEDIUM_SLIME:
        return "slime";
    case shared::MEDIUM_LAVA:
        return "lava";
    }
    return "water";
}

// What it is treated as.
std::string describe_kind(const World& world, const PickedMaterial& picked, const shared::Material& material)
{
    if (material.flags & shared::MATERIAL_SKY)
        return "sky";
    if (material.flags & shared::MATERIAL_WARP)
        return std::string(name_of_medium(picked.texinfo ? world.media[*picked.texinfo] : shared::MEDIUM_WATER));
    if (material.flags & shared::MATERIAL_GLASS)
        return fmt::format("glass, opacity {:.2f}", material.opacity);
    if (material.flags & shared::MATERIAL_TRANSLUCENT)
        return fmt::format("translucent, opacity {:.2f}", material.opacity);
    return material.flags & shared::MATERIAL_ALPHA_TEST ? "opaque, with holes" : "opaque";
}

std::string describe_surface(const shared::Material& material)
{
    return fmt::format("roughness {:.2f}{}, metalness {:.2f}{}{}{}", material.roughness,
        material.flags & shared::MATERIAL_ROUGHNESS_IN_ALPHA ? " at least, by its alpha" : "", material.metallic,
        material.flags & shared::MATERIAL_METALNESS_IN_ALPHA ? " times its normal map's alpha" : "",
        coat_loss(material) > 0 ? fmt::format(", specular {:.2f}", 1 - coat_loss(material)) : "",
        (material.maps & 0xffff) != 0 ? ", with a normal map" : "");
}

std::string describe_pictures(const Texture& texture)
{
    std::string text = texture.missing ? "picture missing" : "picture " + texture.file;
    if (texture.normals)
        text += ", normals " + texture.normals->file;
    if (texture.emissive)
        text += ", glow " + texture.emissive->file;
    return text;
}

std::string describe_sources(const MaterialSettings& settings)
{
    std::string text = settings.sources.empty() ? "" : fmt::format("by {}", fmt::join(settings.sources, ", "));
    if (settings.is_edited)
        text += text.empty() ? "by `mat`" : ", changed by `mat`";
    return text;
}

} // namespace

std::vector<std::string> describe_material(const Module& m, const PickedMaterial& picked)
{
    const SceneSnapshot& snapshot = *m.view().snapshot;
    const shared::Material& material = snapshot.materials[picked.material];
    const MaterialSettings* settings = m.scene.materials().find(picked.name);
    std::vector<std::string> lines { fmt::format("{}: {}", picked.name, describe_surface(material)) };
    lines.push_back(
        describe_kind(*snapshot.world, picked, material) + (settings && settings->is_screen ? ", a screen" : ""));
    if (picked.texture)
        lines.push_back(describe_pictures(*picked.texture));
    if (material.emission != glm::vec3(0))
        lines.push_back(fmt::format("glows, {:.3g} {:.3g} {:.3g} times its picture", material.emission.x,
            material.emission.y, material.emission.z));
    if (!settings) {
        lines.emplace_back("by its name: no file speaks of it");
        return lines;
    }
    lines.push_back(describe_sources(*settings));
    for (const auto& [attribute, value] : settings->attributes)
        lines.push_back(fmt::format("    {} {}", attribute, value));
    return lines;
}

void MaterialInspector::update(Module& m)
{
    if (cvars::values().pt_show_material == 0 || std::chrono::steady_clock::now() - looked_ < between_picks)
        return;
    looked_ = std::chrono::steady_clock::now();
    const std::optional<PickedMaterial> picked = pick_material(m);
    lines_ = picked ? describe_material(m, *picked) : std::vector<std::string> { "no surface is under the crosshair" };
}

std::vector<PanelLine> MaterialInspector::describe(size_t columns) const
{
    std::vector<PanelLine> lines;
    if (cvars::values().pt_show_material == 0)
        return lines;
    for (const std::string& line : lines_)
        for (const std::string& part : wrap_line(line, columns))
            lines.push_back({ part, &line == &lines_.front() });
    return lines;
}

} // namespace vkpt
