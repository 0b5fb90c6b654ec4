// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/noise.hpp"
#include "tools/asset_generator/surface.hpp"

#include "formats/bsp.hpp"

#include <cmath>

namespace vkpt::tools {

namespace {
using namespace formats;

Surface paint_rock(glm::vec2 uv)
{
    const glm::vec2 warp(fractal_noise(uv, 5, 4, 201) - 0.5f, fractal_noise(uv, 5, 4, 202) - 0.5f);
    const CellNoise slabs = cell_noise(uv + warp * 0.16f, 5, 203);
    const float crack = slabs.second - slabs.nearest;
    const float cloud = fractal_noise(uv, 4, 6, 204), fine = fractal_noise(uv, 48, 3, 205);
    glm::vec3 colour = glm::mix(glm::vec3(0.30f, 0.26f, 0.22f), glm::vec3(0.52f, 0.46f, 0.39f), cloud);
    colour = hue_shift(colour, (fine - 0.5f) * 0.35f + (float(slabs.id % 64) / 63.0f - 0.5f) * 0.25f);
    colour *= 0.55f + 0.45f * glm::smoothstep(0.0f, 0.14f, crack);
    const float height = 2.2f * glm::smoothstep(0.0f, 0.3f, crack) + cloud * 2 + fine * 0.7f;
    return { colour, height };
}

Surface paint_grass(glm::vec2 uv)
{
    const float cloud = fractal_noise(uv, 4, 5, 211);
    const float bend = fractal_noise(uv, 8, 2, 212) * 0.03f;
    const float blades = fractal_noise(uv + glm::vec2(bend, 0), { 72, 18 }, 3, 213);
    const float cross = fractal_noise(uv + glm::vec2(0, bend), { 24, 64 }, 3, 214);
    const float lush = glm::smoothstep(0.35f, 0.65f, cloud);
    glm::vec3 colour = glm::mix(glm::vec3(0.34f, 0.35f, 0.19f), glm::vec3(0.22f, 0.32f, 0.15f), lush);
    colour = hue_shift(colour, (blades - 0.5f) * 1.1f + (cross - 0.5f) * 0.6f);
    const float soil = glm::smoothstep(0.66f, 0.76f, fractal_noise(uv, 9, 4, 215));
    colour = glm::mix(colour, glm::vec3(0.32f, 0.25f, 0.17f) * (0.7f + 0.6f * cross), soil);
    return { colour, (blades + cross) * 0.8f };
}

Surface paint_gravel(glm::vec2 uv)
{
    const CellNoise big = cell_noise(uv, 18, 221), small = cell_noise(uv, 40, 223);
    const CellNoise& stone = big.second - big.nearest > 0.22f ? big : small;
    const float dome = glm::clamp(1.0f - stone.nearest * 1.3f, 0.0f, 1.0f);
    const float own = float(stone.id % 200) / 199.0f;
    glm::vec3 colour = glm::mix(glm::vec3(0.38f, 0.35f, 0.31f), glm::vec3(0.62f, 0.58f, 0.52f), own);
    colour = hue_shift(colour, (fractal_noise(uv, 64, 2, 225) - 0.5f) * 0.3f) * (0.45f + 0.55f * dome);
    return { colour, dome * (stone.id == big.id ? 1.4f : 0.7f) };
}

// Dark crust drifting on a glowing melt.
Surface paint_lava(glm::vec2 uv)
{
    const glm::vec2 warp(fractal_noise(uv, 4, 4, 231) - 0.5f, fractal_noise(uv, 4, 4, 232) - 0.5f);
    const CellNoise crust = cell_noise(uv + warp * 0.3f, 5, 233);
    const float heat = 1.0f - glm::smoothstep(0.02f, 0.55f, crust.second - crust.nearest);
    const float glow = glm::clamp(heat + 0.55f * (fractal_noise(uv, 6, 5, 234) - 0.42f), 0.0f, 1.0f);
    const glm::vec3 dark(0.24f, 0.03f, 0.01f), red(0.86f, 0.20f, 0.02f), yellow(1.0f, 0.78f, 0.26f);
    const glm::vec3 colour = glow < 0.5f ? glm::mix(dark, red, glow * 2) : glm::mix(red, yellow, glow * 2 - 1);
    return { colour, (1 - glow) * 1.2f };
}

// Bright caustic lines over a body of colour: water and slime.
Recipe liquid(glm::vec3 deep, glm::vec3 bright, int cells, uint32_t seed)
{
    return [=](glm::vec2 uv) {
        const glm::vec2 warp(fractal_noise(uv, 3, 3, seed) - 0.5f, fractal_noise(uv, 3, 3, seed + 1) - 0.5f);
        const CellNoise a = cell_noise(uv + warp * 0.3f, cells, seed + 2);
        const CellNoise b = cell_noise(uv - warp * 0.25f, cells + 3, seed + 3);
        const float line = std::pow(1.0f - glm::clamp(a.second - a.nearest, 0.0f, 1.0f), 6.0f) * 0.5f
            + std::pow(1.0f - glm::clamp(b.second - b.nearest, 0.0f, 1.0f), 8.0f) * 0.3f;
        const float cloud = fractal_noise(uv, 4, 4, seed + 4);
        return Surface { glm::mix(deep * (0.75f + 0.5f * cloud), bright, glm::clamp(line, 0.0f, 1.0f)), line * 0.4f };
    };
}

Surface paint_glass(glm::vec2 uv)
{
    const float smear = fractal_noise(uv, { 5, 9 }, 4, 251);
    const float rim = wrapped_box(uv, glm::vec2(0.02f), glm::vec2(0.98f));
    const glm::vec3 tint = hue_shift({ 0.62f, 0.78f, 0.80f }, (smear - 0.5f) * 0.16f);
    return { tint * (rim > 0 ? 0.5f : 1.0f), rim > 0 ? 0.6f : 0.0f };
}

// Stands for the sky box in editors and in average colours.
Surface paint_sky(glm::vec2 uv)
{
    const float cloud = fractal_noise(uv, 4, 6, 261);
    const float fade = 0.5f - 0.5f * std::cos(uv.y * 6.2831853f);
    const glm::vec3 air = glm::mix(glm::vec3(0.35f, 0.38f, 0.58f), glm::vec3(0.86f, 0.58f, 0.44f), fade);
    return { glm::mix(air, glm::vec3(0.95f, 0.76f, 0.68f), glm::smoothstep(0.52f, 0.72f, cloud)), 0 };
}
}

std::vector<Texture> natural_textures()
{
    return {
        { "vkpt/rock", 256, paint_rock },
        { "vkpt/grass", 256, paint_grass },
        { "vkpt/gravel", 256, paint_gravel },
        { "vkpt/lava", 256, paint_lava, SURF_LIGHT | SURF_WARP, CONTENTS_LAVA, 700 },
        { "vkpt/slime", 256, liquid({ 0.14f, 0.36f, 0.06f }, { 0.66f, 0.95f, 0.28f }, 6, 241),
            SURF_LIGHT | SURF_WARP | SURF_TRANS66, CONTENTS_SLIME, 240 },
        { "vkpt/water", 256, liquid({ 0.10f, 0.34f, 0.40f }, { 0.62f, 0.86f, 0.86f }, 5, 245), SURF_WARP | SURF_TRANS33,
            CONTENTS_WATER },
        { "vkpt/glass", 128, paint_glass, SURF_TRANS33, CONTENTS_WINDOW },
        { "vkpt/glass_dark", 128,
            [](glm::vec2 uv) {
                const Surface clear = paint_glass(uv);
                return Surface { clear.colour * glm::vec3(0.5f, 0.62f, 0.7f), clear.height };
            },
            SURF_TRANS66, CONTENTS_WINDOW },
        { "vkpt/sky", 128, paint_sky, SURF_SKY | SURF_LIGHT, 0, 60 },
    };
}

} // namespace vkpt::tools
