// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/material_guess.hpp"

#include "ref_vkpt/scene/material_library.hpp"
#include "ref_vkpt/scene/world.hpp"

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

} // namespace

SurfaceGuess guess_surface(std::string_view texture, const MaterialDefaults& defaults)
{
    for (const Row& row : rows)
        if (texture.find(row.part) != std::string_view::npos)
            return row.surface;
    return { defaults.roughness, defaults.metallic };
}

void apply_material(SurfaceGuess& surface, std::string_view name, const MaterialDefaults& defaults)
{
    const MaterialSettings* settings = defaults.library ? defaults.library->find(name) : nullptr;
    if (!settings)
        return;
    if (settings->roughness >= 0)
        surface.roughness = settings->roughness;
    if (settings->metalness >= 0)
        surface.metallic = settings->metalness;
    surface.base_factor = settings->base_factor;
}

} // namespace vkpt
