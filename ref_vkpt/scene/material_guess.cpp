// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/material_guess.hpp"

#include "ref_vkpt/scene/material_library.hpp"
#include "ref_vkpt/scene/world.hpp"

#include <algorithm>
#include <cmath>

namespace vkpt {

namespace {

struct Row {
    std::string_view part;
    SurfaceGuess surface;
};

// The first row whose part occurs in the name counts. Metals stay rough enough for next event estimation to find their
// highlights; a mirror has to be asked for by name.
constexpr Row rows[] = {
    { "mirror", { 0.0f, 1.0f } },
    { "chrome", { 0.0f, 1.0f } },
    { "gloss", { 0.32f, 0.0f } },
    { "tread", { 0.35f, 0.8f } },
    { "marble", { 0.32f, 0.0f } },
    { "tile", { 0.4f, 0.0f } },
    { "glass", { 0.1f, 0.0f } },
    { "window", { 0.1f, 0.0f } },
    { "wndow", { 0.1f, 0.0f } },
    { "water", { 0.05f, 0.0f } },
    { "metal", { 0.42f, 0.8f } },
    { "grate", { 0.4f, 0.8f } },
    { "pipe", { 0.35f, 0.8f } },
    { "comp", { 0.4f, 0.3f } },
    { "weapons/v_", { 0.35f, 0.5f } },
};

// The mip of a map less that of the texture, in 1 / MATERIAL_MIP_ONE and of MATERIAL_MIP_BITS bits.
uint32_t pack_mips(uint32_t size, uint32_t texture_size)
{
    const auto longer_side = [](uint32_t packed) { return float(std::max(packed & 0xffff, packed >> 16)); };
    const float mips = std::clamp(std::log2(longer_side(size) / longer_side(texture_size)), -15.0f, 15.0f);
    return uint32_t(int32_t(std::lround(mips * shared::MATERIAL_MIP_ONE))) & ((1u << shared::MATERIAL_MIP_BITS) - 1);
}

void set_coat_loss(shared::Material& material, float loss)
{
    const auto steps = uint32_t(std::lround(std::clamp(loss, 0.0f, 1.0f) * float(shared::MATERIAL_COAT_ONE)));
    material.flags &= ~(shared::MATERIAL_COAT_ONE << shared::MATERIAL_COAT_SHIFT);
    material.flags |= steps << shared::MATERIAL_COAT_SHIFT;
}

// The number and the scale of a normal map, and what its alpha says.
void set_normal_map(shared::Material& material, const SurfaceGuess& surface, const TextureMaps& maps, float bump_scale)
{
    constexpr float most = float((1u << shared::MATERIAL_BUMP_BITS) - 1);
    const float bump = std::clamp(surface.bump_scale * bump_scale * shared::MATERIAL_BUMP_ONE, 0.0f, most);
    material.maps |= maps.normals.slot;
    material.map_scales |= uint32_t(std::lround(bump))
        | pack_mips(maps.normals.packed_size, material.texture_size) << shared::MATERIAL_BUMP_BITS;
    if (maps.texture_has_roughness && !(material.flags & shared::MATERIAL_ALPHA_TEST)) {
        material.flags |= shared::MATERIAL_ROUGHNESS_IN_ALPHA;
        material.roughness = surface.min_roughness;
    }
    if (maps.has_metalness && surface.metalness_factor >= 0) {
        material.flags |= shared::MATERIAL_METALNESS_IN_ALPHA;
        material.metallic = surface.metalness_factor;
    }
}

} // namespace

float coat_loss(const shared::Material& material)
{
    return float(material.flags >> shared::MATERIAL_COAT_SHIFT & shared::MATERIAL_COAT_ONE)
        / float(shared::MATERIAL_COAT_ONE);
}

SurfaceGuess guess_surface(std::string_view texture, const MaterialDefaults& defaults)
{
    for (const Row& row : rows)
        if (texture.find(row.part) != std::string_view::npos)
            return row.surface;
    return { defaults.roughness, defaults.metallic };
}

const MaterialSettings* MaterialDefaults::find(std::string_view name) const
{
    return materials ? materials->find(name) : nullptr;
}

void apply_material(SurfaceGuess& surface, const MaterialSettings* settings)
{
    if (!settings)
        return;
    if (settings->roughness >= 0)
        surface.roughness = surface.min_roughness = settings->roughness;
    if (settings->metalness >= 0)
        surface.metallic = settings->metalness;
    surface.pane_roughness = settings->pane_roughness;
    surface.specular_factor = settings->specular_factor;
    surface.base_factor = settings->base_factor;
    surface.bump_scale = settings->bump_scale;
    surface.emissive_factor = settings->emissive_factor;
    surface.metalness_factor = settings->metalness >= 0 ? -1 : settings->metalness_factor;
}

void set_surface(
    shared::Material& material, const SurfaceGuess& surface, const TextureMaps& maps, const MaterialDefaults& defaults)
{
    material.tint = glm::vec3(surface.base_factor);
    const bool is_pane = (material.flags & shared::MATERIAL_GLASS) && surface.pane_roughness >= 0;
    material.roughness = is_pane ? surface.pane_roughness : surface.roughness;
    material.metallic = surface.metallic;
    set_coat_loss(material, 1 - surface.specular_factor);
    material.maps = material.map_scales = 0;
    if (maps.normals.slot != 0 && !(material.flags & shared::MATERIAL_WARP)) // liquids have waves instead
        set_normal_map(material, surface, maps, defaults.bump_scale);
    if (maps.emissive.slot != 0) {
        material.maps |= maps.emissive.slot << 16;
        material.map_scales |= pack_mips(maps.emissive.packed_size, material.texture_size)
            << (shared::MATERIAL_BUMP_BITS + shared::MATERIAL_MIP_BITS);
    }
}

} // namespace vkpt
