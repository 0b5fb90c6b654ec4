// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/material_library.hpp"

#include "common/numbers.hpp"

#include <algorithm>
#include <glm/common.hpp>

namespace vkpt {

namespace {

using Attributes = std::map<std::string, std::string, std::less<>>;

float number_of(const Attributes& attributes, std::string_view name, float fallback)
{
    const auto found = attributes.find(name);
    return found != attributes.end() ? parse_number<float>(found->second).value_or(fallback) : fallback;
}

std::string word_of(const Attributes& attributes, std::string_view name)
{
    const auto found = attributes.find(name);
    return found != attributes.end() ? found->second : std::string();
}

// With the material's own name in place of the first asterisk: without its folders, or all of it where there are two.
std::string put_name(std::string file, std::string_view name)
{
    const size_t at = file.find('*');
    if (at == std::string::npos)
        return file;
    const bool is_whole = file.substr(at).starts_with("**");
    const bool is_wall = !name.starts_with("models/") && !name.starts_with("players/");
    std::string inserted(is_whole ? name : name.substr(name.rfind('/') + 1));
    if (is_whole && is_wall)
        inserted.insert(0, "textures/"); // which material_name() leaves out
    return file.replace(at, is_whole ? 2 : 1, inserted);
}

// Nothing: it is not said. Empty, written 0: none.
std::optional<std::string> file_of(const Attributes& attributes, std::string_view attribute, std::string_view name)
{
    const auto found = attributes.find(attribute);
    if (found == attributes.end())
        return std::nullopt;
    return found->second == "0" ? std::string() : put_name(found->second, name);
}

uint32_t medium_of_kind(std::string_view kind)
{
    return kind == "WATER" ? shared::MEDIUM_WATER
        : kind == "SLIME"  ? shared::MEDIUM_SLIME
        : kind == "LAVA"   ? shared::MEDIUM_LAVA
                           : shared::MEDIUM_NONE;
}

// Of the picture; as Q2RTX has it for its screens where the file does not say. Nothing that has no size.
glm::vec4 screen_area_of(const Attributes& attributes)
{
    const glm::vec4 usual = MaterialSettings().screen_area;
    const glm::vec4 area = glm::clamp(
        glm::vec4(number_of(attributes, "screen_left", usual.x), number_of(attributes, "screen_top", usual.y),
            number_of(attributes, "screen_right", usual.z), number_of(attributes, "screen_bottom", usual.w)),
        0.0f, 1.0f);
    constexpr float smallest = 1 / 256.0f;
    return area.z - area.x >= smallest && area.w - area.y >= smallest ? area : usual;
}

MaterialSettings make_settings(std::string_view name, const Attributes& attributes)
{
    constexpr float brightest = 16, usual_threshold = 215, steepest = 4, max_emissive = 1000, smooth_pane = 0.1f;
    MaterialSettings settings;
    settings.roughness = std::min(number_of(attributes, "roughness_override", -1), 1.0f);
    settings.metalness = std::min(number_of(attributes, "metalness_override", -1), 1.0f);
    const std::string kind = formats::kind_name(word_of(attributes, "kind"));
    if (kind == "CHROME") { // a mirror, unless it says more
        settings.roughness = settings.roughness < 0 ? 0 : settings.roughness;
        settings.metalness = settings.metalness < 0 ? 1 : settings.metalness;
    }
    if (kind == "GLASS" && settings.roughness < 0)
        settings.pane_roughness = smooth_pane;
    settings.medium = medium_of_kind(kind);
    settings.is_sky = kind == "SKY";
    settings.is_invisible = kind == "INVISIBLE";
    settings.is_screen = kind == "CAMERA";
    settings.screen_area = screen_area_of(attributes);
    if (attributes.contains("synth_emissive"))
        settings.glow_threshold = number_of(attributes, "synth_emissive", 0) > 0
            ? int(std::clamp(number_of(attributes, "emissive_threshold", usual_threshold), 1.0f, 255.0f))
            : 0;
    settings.specular_factor = std::clamp(number_of(attributes, "specular_factor", 1), 0.0f, 1.0f);
    settings.base_factor = std::clamp(number_of(attributes, "base_factor", 1), 0.0f, brightest);
    settings.bump_scale = std::clamp(number_of(attributes, "bump_scale", 1), 0.0f, steepest);
    settings.metalness_factor = std::clamp(number_of(attributes, "metalness_factor", 1), 0.0f, 1.0f);
    settings.emissive_factor = std::clamp(number_of(attributes, "emissive_factor", 1), 0.0f, max_emissive);
    settings.default_radiance = std::clamp(number_of(attributes, "default_radiance", 1), 0.0f, max_emissive);
    settings.takes_light_value = number_of(attributes, "bsp_radiance", 1) > 0;
    settings.takes_lightstyles = number_of(attributes, "light_styles", 1) > 0;
    settings.base_file = file_of(attributes, "texture_base", name).value_or("");
    settings.mask_file = file_of(attributes, "texture_mask", name).value_or("");
    settings.normals_file = file_of(attributes, "texture_normals", name);
    settings.emissive_file = file_of(attributes, "texture_emissive", name);
    settings.attributes = attributes;
    return settings;
}

} // namespace

void MaterialLibrary::add_to(Names& names, const formats::MaterialFile& file)
{
    for (const formats::MaterialEntry& entry : file.entries)
        for (const std::string& name : entry.names)
            for (const auto& [attribute, value] : entry.attributes)
                names[name].insert_or_assign(attribute, value);
}

void MaterialLibrary::refresh(const std::string& name)
{
    Attributes all;
    if (const auto found = edits_.find(name); found != edits_.end())
        all = found->second;
    if (const auto found = files_.find(name); found != files_.end())
        all.insert(found->second.begin(), found->second.end());
    if (all.empty()) {
        settings_.erase(name);
        return;
    }
    MaterialSettings settings = make_settings(name, all);
    if (const auto found = sources_.find(name); found != sources_.end())
        settings.sources = found->second;
    settings.is_edited = edits_.contains(name);
    settings_.insert_or_assign(name, std::move(settings));
}

void MaterialLibrary::add(const formats::MaterialFile& file)
{
    add_to(files_, file);
    for (const formats::MaterialEntry& entry : file.entries)
        for (const std::string& name : entry.names) {
            std::vector<std::string>& sources = sources_[name];
            if (sources.empty() || sources.back() != file.file)
                sources.push_back(file.file);
            refresh(name);
        }
}

void MaterialLibrary::take_edits(const formats::MaterialFile& file)
{
    add_to(edits_, file);
    for (const formats::MaterialEntry& entry : file.entries)
        for (const std::string& name : entry.names)
            refresh(name);
}

void MaterialLibrary::forget_files()
{
    files_.clear();
    sources_.clear();
    settings_.clear();
    for (const auto& [name, attributes] : edits_)
        refresh(name);
}

void MaterialLibrary::edit(std::string_view texture, std::string_view attribute, std::string_view value)
{
    const std::string name = formats::material_name(texture);
    Attributes& attributes = edits_[name];
    if (value.empty())
        attributes.erase(std::string(attribute));
    else
        attributes.insert_or_assign(std::string(attribute), std::string(value));
    if (attributes.empty())
        edits_.erase(name);
    refresh(name);
}

std::vector<formats::MaterialEntry> MaterialLibrary::edits() const
{
    std::vector<formats::MaterialEntry> entries;
    for (const auto& [name, attributes] : edits_)
        entries.push_back({ { name }, { attributes.begin(), attributes.end() } });
    return entries;
}

const MaterialSettings* MaterialLibrary::find(std::string_view name) const
{
    const auto found = settings_.find(name);
    return found != settings_.end() ? &found->second : nullptr;
}

} // namespace vkpt
