// SPDX-License-Identifier: GPL-2.0-or-later
// The material atlas that all models are skinned with: 8 x 8 cells of 32 pixels.
#include "tools/asset_generator/mesh.hpp"

#include "tools/asset_generator/noise.hpp"
#include "tools/asset_generator/palette.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <utility>

namespace vkpt::tools {

namespace {
struct Look {
    glm::vec3 colour;
    float rim = 0.5f; // how dark the cell's border gets, 1 not at all
    float grain = 0.1f;
    bool glows = false;
};

const std::pair<Material, Look> looks[] = {
    { Material::steel, { { 0.58f, 0.60f, 0.63f } } },
    { Material::dark_steel, { { 0.36f, 0.39f, 0.43f } } },
    { Material::gunmetal, { { 0.22f, 0.24f, 0.27f } } },
    { Material::rubber, { { 0.10f, 0.10f, 0.11f }, 0.7f } },
    { Material::amber_paint, { { 0.80f, 0.48f, 0.12f } } },
    { Material::teal_paint, { { 0.16f, 0.46f, 0.50f } } },
    { Material::red_paint, { { 0.66f, 0.16f, 0.11f } } },
    { Material::green_paint, { { 0.24f, 0.46f, 0.22f } } },
    { Material::blue_paint, { { 0.20f, 0.32f, 0.66f } } },
    { Material::copper, { { 0.68f, 0.43f, 0.29f } } },
    { Material::gold, { { 0.76f, 0.60f, 0.28f } } },
    { Material::chrome, { { 0.76f, 0.78f, 0.80f }, 0.75f, 0.04f } },
    { Material::cloth, { { 0.30f, 0.28f, 0.24f }, 0.75f, 0.3f } },
    { Material::skin, { { 0.74f, 0.52f, 0.40f }, 0.85f, 0.06f } },
    { Material::white_paint, { { 0.74f, 0.74f, 0.72f } } },
    { Material::visor, { { 0.08f, 0.26f, 0.30f }, 0.5f, 0.02f } },
    { Material::glow_amber, { { 1.0f, 0.64f, 0.16f }, 0.8f, 0, true } },
    { Material::glow_teal, { { 0.30f, 0.95f, 1.0f }, 0.8f, 0, true } },
    { Material::glow_red, { { 1.0f, 0.22f, 0.12f }, 0.8f, 0, true } },
    { Material::glow_green, { { 0.36f, 1.0f, 0.40f }, 0.8f, 0, true } },
    { Material::glow_blue, { { 0.32f, 0.52f, 1.0f }, 0.8f, 0, true } },
    { Material::glow_violet, { { 0.86f, 0.44f, 1.0f }, 0.8f, 0, true } },
    { Material::glow_white, { { 1.0f, 0.98f, 0.92f }, 0.9f, 0, true } },
    { Material::fire, { { 1.0f, 0.58f, 0.14f }, 1.0f, 0.5f, true } },
    { Material::flesh, { { 0.52f, 0.12f, 0.10f }, 0.8f, 0.5f } },
    { Material::bone, { { 0.78f, 0.72f, 0.58f }, 0.8f, 0.15f } },
    { Material::hazard, { { 0.80f, 0.60f, 0.10f } } },
    { Material::medic, { { 0.76f, 0.77f, 0.76f } } },
    { Material::grille, { { 0.30f, 0.31f, 0.33f } } },
    { Material::wood, { { 0.44f, 0.29f, 0.17f }, 0.7f, 0.3f } },
    { Material::smoke, { { 0.34f, 0.32f, 0.31f }, 1.0f, 0.4f } },
};

Look look_of(Material material, glm::vec3 armour)
{
    if (material == Material::armour)
        return { armour };
    const auto found = std::ranges::find(looks, material, &std::pair<Material, Look>::first);
    return found != std::end(looks) ? found->second : Look { glm::vec3(0.5f) };
}

glm::vec3 paint_cell(Material material, const Look& look, glm::vec2 uv, uint32_t seed)
{
    const glm::vec2 edge2 = glm::min(uv, 1.0f - uv);
    const float edge = std::min(edge2.x, edge2.y);
    const float noise = fractal_noise(uv, 6, 4, seed) - 0.5f;
    glm::vec3 colour = look.colour * (1.0f + look.grain * 2.4f * noise);
    if (look.glows)
        return glm::clamp(
            glm::mix(colour, glm::vec3(1, 1, 0.96f), 0.55f * glm::smoothstep(0.1f, 0.5f, edge)), 0.0f, 1.0f);
    if (material == Material::hazard && glm::fract((uv.x + uv.y) * 2.5f) < 0.5f)
        colour = glm::vec3(0.09f);
    if (material == Material::grille && glm::fract(uv.y * 6) < 0.45f)
        colour *= 0.3f;
    if (material == Material::medic) {
        const glm::vec2 q = glm::abs(uv - 0.5f);
        if (std::max(q.x, q.y) < 0.32f && std::min(q.x, q.y) < 0.1f)
            colour = glm::vec3(0.16f, 0.62f, 0.26f);
    }
    const float bright_line = glm::smoothstep(0.04f, 0.07f, edge) * glm::smoothstep(0.13f, 0.09f, edge);
    colour *= glm::mix(look.rim, 1.0f, glm::smoothstep(0.0f, 0.08f, edge));
    colour *= 1.0f + 0.25f * bright_line;
    colour *= 1.0f - 0.18f * (uv.y - 0.5f); // light from above
    return glm::clamp(colour, 0.0f, 1.0f);
}
}

formats::IndexedImage make_skin(glm::vec3 armour)
{
    constexpr int side = 256, cell = 32;
    std::vector<glm::vec4> pixels(size_t(side) * side, glm::vec4(0.5f, 0.5f, 0.5f, 1));
    for (int i = 0; i < int(Material::count); i++) {
        const Look look = look_of(Material(i), armour);
        for (int y = 0; y < cell; y++)
            for (int x = 0; x < cell; x++) {
                const glm::vec2 uv = (glm::vec2(x, y) + 0.5f) / float(cell);
                const size_t at = size_t(i / 8 * cell + y) * side + size_t(i % 8 * cell + x);
                pixels[at] = glm::vec4(paint_cell(Material(i), look, uv, 500u + uint32_t(i)), 1);
            }
    }
    return quantise(side, side, pixels, 0.3f, false);
}

} // namespace vkpt::tools
