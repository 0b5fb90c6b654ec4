// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/canvas.hpp"
#include "tools/asset_generator/noise.hpp"
#include "tools/asset_generator/surface.hpp"

#include <cmath>

namespace vkpt::tools {

namespace {
constexpr glm::vec3 hull { 0.66f, 0.67f, 0.66f }, slate { 0.30f, 0.34f, 0.39f }, gunmetal { 0.24f, 0.26f, 0.29f };
constexpr glm::vec3 amber { 0.86f, 0.52f, 0.12f }, teal { 0.13f, 0.46f, 0.50f }, rust { 0.50f, 0.27f, 0.15f };

Recipe plate_recipe(std::vector<Plate> list, PlateStyle style)
{
    return [list = std::move(list), style](glm::vec2 uv) { return plates(uv, list, style); };
}

Recipe wall_panel(glm::vec3 main, glm::vec3 accent, uint32_t seed)
{
    return plate_recipe(
        {
            { { 0.0f, 0.0f }, { 1.0f, 0.11f }, slate },
            { { 0.0f, 0.11f }, { 0.5f, 0.70f }, main, 0.04f },
            { { 0.5f, 0.11f }, { 1.0f, 0.70f }, main, 0.04f },
            { { 0.0f, 0.70f }, { 1.0f, 0.76f }, accent, 0, 0.6f },
            { { 0.0f, 0.76f }, { 0.25f, 1.0f }, main * 0.8f },
            { { 0.25f, 0.76f }, { 0.75f, 1.0f }, slate, 0.03f },
            { { 0.75f, 0.76f }, { 1.0f, 1.0f }, main * 0.8f },
        },
        { .seed = seed });
}

Recipe wall_tech()
{
    std::vector<Plate> list;
    constexpr int n = 8;
    // Boxes of differing size from a coarse grid; two neighbours merge where the hash says so.
    for (int y = 0; y < n; y++) {
        for (int x = 0; x < n; x += 2) {
            const float u = float(x) / n, v = float(y) / n, step = 1.0f / n;
            const bool wide = hash_unit(x, y, 91) < 0.5f;
            const glm::vec3 tone = hue_shift(slate, (hash_unit(x, y, 92) - 0.5f) * 0.5f);
            const float lift = 0.5f + hash_unit(x, y, 93);
            if (wide) {
                list.push_back({ { u, v }, { u + 2 * step, v + step }, tone, 0.02f, lift });
            } else {
                list.push_back({ { u, v }, { u + step, v + step }, tone, 0, lift });
                list.push_back({ { u + step, v }, { u + 2 * step, v + step }, tone * 0.8f, 0, 0.4f });
            }
        }
    }
    const Recipe base = plate_recipe(std::move(list), { .gap = 0.005f, .cut = 0.015f, .wear = 0.6f, .seed = 23 });
    return [base](glm::vec2 uv) {
        Surface s = base(uv);
        const float cable = std::abs(uv.y - 0.5f - 0.004f * std::sin(uv.x * 6.2832f * 2)); // a pipe across
        if (cable < 0.028f) {
            const float round = std::sqrt(1 - cable * cable / (0.028f * 0.028f));
            s = { glm::vec3(0.42f, 0.25f, 0.12f) * (0.5f + 0.5f * round), 1.2f + 1.5f * round };
        }
        return s;
    };
}

Recipe concrete(float joints, uint32_t seed)
{
    return [=](glm::vec2 uv) {
        const float cloud = fractal_noise(uv, 3, 6, seed), fine = fractal_noise(uv, 64, 2, seed + 3);
        const float streak = fractal_noise(uv, { 28, 2 }, 4, seed + 5);
        glm::vec3 colour = glm::mix(glm::vec3(0.44f, 0.43f, 0.41f), glm::vec3(0.60f, 0.58f, 0.55f), cloud);
        colour = hue_shift(colour, (fine - 0.5f) * 0.16f);
        colour *= 1.0f - 0.28f * glm::smoothstep(0.52f, 0.8f, streak);
        float height = cloud * 0.6f + fine * 0.25f;
        const CellNoise pores = cell_noise(uv, 20, seed + 9);
        if (pores.nearest < 0.10f * float(pores.id % 100) / 100.0f + 0.015f) {
            colour *= 0.62f;
            height -= 0.4f;
        }
        if (joints > 0) {
            const glm::vec2 cell = uv * joints - glm::floor(uv * joints);
            const glm::vec2 edge = glm::min(cell, 1.0f - cell) / joints;
            const float joint = std::min(edge.x, edge.y);
            const float depth = glm::smoothstep(0.009f, 0.003f, joint);
            colour *= 1.0f - 0.6f * depth;
            height -= 1.2f * depth;
            const glm::vec2 from_corner = glm::abs(cell - 0.5f) - 0.33f; // tie holes
            if (glm::length(from_corner) / joints < 0.012f) {
                colour *= 0.35f;
                height -= 1.2f;
            }
        }
        return Surface { colour, height };
    };
}

Recipe tiles(int count, glm::vec3 light, glm::vec3 dark, glm::vec3 grout, uint32_t seed)
{
    return [=](glm::vec2 uv) {
        const glm::vec2 p = uv * float(count);
        const glm::ivec2 cell(glm::floor(p));
        const glm::vec2 local = p - glm::floor(p);
        const glm::vec2 edge2 = glm::min(local, 1.0f - local);
        const float edge = std::min(edge2.x, edge2.y) / float(count);
        const uint32_t id = hash_integers(uint32_t(cell.x), uint32_t(cell.y), seed);
        const float warp = fractal_noise(uv, 4, 5, seed + id % 7);
        const float vein = std::abs(std::sin((warp * 3 + fractal_noise(uv, 8, 3, seed + 77)) * 9.0f));
        glm::vec3 colour = (cell.x + cell.y) & 1 ? dark : light;
        colour = hue_shift(colour, (float(id % 256) / 255.0f - 0.5f) * 0.12f + (warp - 0.5f) * 0.3f);
        colour = glm::mix(colour * 1.25f, colour, glm::smoothstep(0.0f, 0.12f, vein));
        const float rise = glm::smoothstep(0.002f, 0.008f, edge);
        return Surface { glm::mix(grout, glm::clamp(colour, 0.0f, 1.0f), rise), rise };
    };
}

Recipe tread_plate()
{
    return [](glm::vec2 uv) {
        const float cloud = fractal_noise(uv, 4, 5, 41), fine = fractal_noise(uv, 96, 2, 42);
        const glm::vec2 p = uv * 12.0f;
        const glm::ivec2 cell(glm::floor(p));
        const glm::vec2 q = p - glm::floor(p) - 0.5f;
        const bool rising = (cell.x + cell.y) & 1;
        const glm::vec2 r = rising ? glm::vec2(q.x + q.y, q.x - q.y) : glm::vec2(q.x - q.y, q.x + q.y);
        const float lozenge = glm::length(r * glm::vec2(0.95f, 3.4f)) - 0.48f;
        const float rise = glm::smoothstep(0.12f, -0.1f, lozenge);
        glm::vec3 colour = hue_shift({ 0.36f, 0.37f, 0.39f }, (fine - 0.5f) * 0.2f + (cloud - 0.5f) * 0.5f);
        colour = glm::mix(colour, colour * 1.35f, rise);
        colour *= 1.0f - 0.35f * glm::smoothstep(0.05f, 0.2f, lozenge) * glm::smoothstep(0.4f, 0.7f, cloud);
        return Surface { colour, rise * 1.1f };
    };
}

Recipe brushed_metal(glm::vec3 tone, float contrast, uint32_t seed)
{
    return [=](glm::vec2 uv) {
        const float streak = fractal_noise(uv, { 4, 128 }, 2, seed) - 0.5f;
        const float cloud = fractal_noise(uv, 3, 4, seed + 5) - 0.5f;
        const float seam = wrapped_box(uv, { 0.006f, 0.006f }, { 0.994f, 0.994f });
        glm::vec3 colour = hue_shift(tone, streak * contrast + cloud * 0.18f);
        const float rise = glm::smoothstep(0.0f, -0.006f, seam);
        return Surface { colour * (0.45f + 0.55f * rise), rise };
    };
}

Recipe rusty_metal()
{
    return [](glm::vec2 uv) {
        const float cloud = fractal_noise(uv, 3, 6, 61), fine = fractal_noise(uv, 40, 3, 62);
        const float spread = glm::smoothstep(0.42f, 0.6f, cloud * 0.75f + fine * 0.25f);
        const glm::vec3 sound = hue_shift({ 0.33f, 0.35f, 0.36f }, (fine - 0.5f) * 0.2f);
        const glm::vec3 rusty = glm::mix(rust * 0.7f, glm::vec3(0.66f, 0.38f, 0.18f), fine);
        const glm::vec2 q = uv * 2.0f - glm::floor(uv * 2.0f);
        const glm::vec2 e = glm::min(q, 1.0f - q);
        const float seam = glm::smoothstep(0.004f, 0.014f, std::min(e.x, e.y));
        return Surface { glm::mix(sound, rusty, spread) * (0.4f + 0.6f * seam), seam + spread * fine * 0.9f };
    };
}

Recipe blocks(glm::vec3 tone, glm::vec3 mortar, int rows, int columns, uint32_t seed)
{
    return [=](glm::vec2 uv) {
        const float wobble = (fractal_noise(uv, 8, 3, seed) - 0.5f) * 0.012f;
        const float row_at = (uv.y + wobble) * float(rows);
        const int row = int(std::floor(row_at));
        const float column_at = (uv.x + wobble) * float(columns) + (row & 1 ? 0.5f : 0.0f);
        const int column = (int(std::floor(column_at)) + columns) % columns;
        const glm::vec2 local(column_at - std::floor(column_at), row_at - std::floor(row_at));
        const glm::vec2 edge2 = glm::min(local, 1.0f - local) / glm::vec2(columns, rows);
        const float edge = std::min(edge2.x, edge2.y);
        const float rise = glm::smoothstep(0.004f, 0.018f, edge);
        const float cloud = fractal_noise(uv, 6, 5, seed + 1), fine = fractal_noise(uv, 64, 2, seed + 2);
        const float own = hash_unit(column, (row + rows) % rows, seed + 3) - 0.5f;
        const glm::vec3 stone = hue_shift(tone, own * 0.28f + (cloud - 0.5f) * 0.5f + (fine - 0.5f) * 0.14f);
        return Surface { glm::mix(mortar * (0.8f + 0.4f * fine), stone, rise),
            rise * 1.6f + cloud * 0.8f + fine * 0.2f };
    };
}

Recipe hazard_trim()
{
    const Recipe base = plate_recipe(
        { { { 0, 0 }, { 1, 0.5f }, { 0.8f, 0.6f, 0.1f }, 0, 0.8f }, { { 0, 0.5f }, { 1, 1 }, gunmetal, 0.03f } },
        { .gap = 0.006f, .cut = 0, .wear = 0.9f, .seed = 71 });
    return [base](glm::vec2 uv) {
        Surface s = base(uv);
        const float phase = (uv.x + uv.y) * 4 - std::floor((uv.x + uv.y) * 4);
        if (uv.y > 0.012f && uv.y < 0.488f && phase < 0.5f && fractal_noise(uv, 40, 3, 72) < 0.66f)
            s.colour *= glm::vec3(0.12f, 0.14f, 0.3f);
        return s;
    };
}

Recipe crate(glm::vec3 tone, std::string_view label, uint32_t seed)
{
    const Recipe base = plate_recipe(
        {
            { { 0.0f, 0.0f }, { 1.0f, 1.0f }, gunmetal, 0, 0.5f },
            { { 0.02f, 0.02f }, { 0.14f, 0.98f }, tone * 0.75f, 0.05f, 2 },
            { { 0.86f, 0.02f }, { 0.98f, 0.98f }, tone * 0.75f, 0.05f, 2 },
            { { 0.14f, 0.02f }, { 0.86f, 0.14f }, tone * 0.75f, 0.04f, 2 },
            { { 0.14f, 0.86f }, { 0.86f, 0.98f }, tone * 0.75f, 0.04f, 2 },
            { { 0.16f, 0.16f }, { 0.84f, 0.84f }, tone, 0.05f, 1 },
        },
        { .wear = 0.8f, .seed = seed });
    const float height = 0.16f;
    const TextShape text
        = text_shape(label, { 0.5f - text_width(label, height) * 0.5f, 0.5f - height * 0.5f }, height, 0.03f);
    return [=](glm::vec2 uv) {
        Surface s = base(uv);
        if (text(uv) < 0 && fractal_noise(uv, 32, 3, seed + 5) < 0.7f)
            s.colour = glm::mix(s.colour, glm::vec3(0.9f, 0.88f, 0.8f), 0.8f);
        for (int i = 0; i < 2; i++) { // two rulers above and below the label
            const float line = std::abs(uv.y - (i ? 0.68f : 0.32f));
            if (line < 0.012f && uv.x > 0.22f && uv.x < 0.78f)
                s.colour = glm::mix(s.colour, amber, 0.75f);
        }
        return s;
    };
}

Recipe sign(std::string_view text, glm::vec3 ink)
{
    const float height = 0.22f;
    const float width = text_width(text, height);
    const float fit = std::min(1.0f, 0.84f / width);
    const TextShape shape = text_shape(
        text, glm::vec2(0.5f - width * fit * 0.5f, 0.5f - height * fit * 0.5f), height * fit, 0.045f * fit);
    const Recipe base = plate_recipe({ { { 0, 0 }, { 1, 1 }, { 0.16f, 0.18f, 0.2f }, 0.05f } }, { .seed = 83 });
    return [=](glm::vec2 uv) {
        Surface s = base(uv);
        const float rule = std::min(std::abs(uv.y - 0.3f), std::abs(uv.y - 0.7f));
        if (shape(uv) < 0 || (rule < 0.01f && std::abs(uv.x - 0.5f) < 0.42f))
            s.colour = ink;
        return s;
    };
}

Recipe wood_planks()
{
    return [](glm::vec2 uv) {
        constexpr int planks = 6;
        const float at = uv.y * planks;
        const int plank = int(at);
        const float local = at - std::floor(at);
        const float grain = fractal_noise(uv, { 4, 96 }, 4, 131u + uint32_t(plank));
        const float rings = std::abs(std::sin(30.0f * fractal_noise(uv, { 2, 12 }, 3, 151u + uint32_t(plank))));
        glm::vec3 colour = glm::mix(glm::vec3(0.34f, 0.20f, 0.11f), glm::vec3(0.58f, 0.38f, 0.22f), grain);
        colour = hue_shift(colour, (hash_unit(plank, 0, 171) - 0.5f) * 0.3f - 0.12f * rings);
        const float rise = glm::smoothstep(0.0f, 0.05f, std::min(local, 1 - local));
        return Surface { colour * (0.35f + 0.65f * rise), rise + grain * 0.3f };
    };
}
}

std::vector<Texture> structural_textures()
{
    const glm::vec3 black_tile(0.13f, 0.14f, 0.16f), white_tile(0.56f, 0.56f, 0.54f);
    return {
        { "vkpt/wall_panel", 256, wall_panel(hull, amber, 11) },
        { "vkpt/wall_teal", 256, wall_panel({ 0.48f, 0.54f, 0.55f }, teal, 12) },
        { "vkpt/wall_dark", 256, wall_panel({ 0.26f, 0.28f, 0.31f }, rust, 13) },
        { "vkpt/wall_tech", 256, wall_tech() },
        { "vkpt/wall_concrete", 256, concrete(2, 21) },
        { "vkpt/wall_brick", 256, blocks({ 0.47f, 0.26f, 0.19f }, { 0.42f, 0.39f, 0.36f }, 12, 4, 31) },
        { "vkpt/wall_sandstone", 256, blocks({ 0.62f, 0.52f, 0.38f }, { 0.34f, 0.28f, 0.21f }, 4, 2, 33) },
        { "vkpt/floor_tile", 256, tiles(4, { 0.40f, 0.41f, 0.42f }, { 0.35f, 0.36f, 0.38f }, glm::vec3(0.12f), 35) },
        { "vkpt/floor_gloss", 256, tiles(2, white_tile, black_tile, glm::vec3(0.2f), 36) },
        { "vkpt/floor_concrete", 256, concrete(1, 22) },
        { "vkpt/floor_tread", 256, tread_plate() },
        { "vkpt/floor_wood", 256, wood_planks() },
        { "vkpt/ceil_concrete", 256, concrete(0, 24) },
        { "vkpt/ceil_panel", 256,
            plate_recipe({ { { 0, 0 }, { 0.5f, 0.5f }, { 0.5f, 0.51f, 0.52f }, 0.03f },
                             { { 0.5f, 0 }, { 1, 0.5f }, { 0.46f, 0.47f, 0.48f }, 0.03f },
                             { { 0, 0.5f }, { 0.5f, 1 }, { 0.46f, 0.47f, 0.48f }, 0.03f },
                             { { 0.5f, 0.5f }, { 1, 1 }, { 0.5f, 0.51f, 0.52f }, 0.03f } },
                { .wear = 0.3f, .seed = 37 }) },
        { "vkpt/trim_metal", 128,
            plate_recipe({ { { 0, 0 }, { 1, 0.3f }, gunmetal }, { { 0, 0.3f }, { 1, 0.7f }, slate, 0.06f, 1.4f },
                             { { 0, 0.7f }, { 1, 1 }, gunmetal } },
                { .gap = 0.012f, .bevel = 0.03f, .cut = 0, .wear = 0.5f, .seed = 43 }) },
        { "vkpt/trim_hazard", 128, hazard_trim() },
        { "vkpt/step_metal", 128,
            plate_recipe({ { { 0, 0 }, { 1, 0.25f }, amber * 0.8f }, { { 0, 0.25f }, { 1, 1 }, slate } },
                { .gap = 0.008f, .bevel = 0.02f, .cut = 0, .wear = 0.9f, .seed = 45 }) },
        { "vkpt/pillar", 128,
            plate_recipe({ { { 0, 0 }, { 0.33f, 1 }, hull * 0.9f }, { { 0.33f, 0 }, { 0.67f, 1 }, hull, 0, 1.6f },
                             { { 0.67f, 0 }, { 1, 1 }, hull * 0.9f } },
                { .gap = 0.012f, .bevel = 0.05f, .cut = 0, .wear = 0.4f, .seed = 47 }) },
        { "vkpt/metal_plate", 256,
            plate_recipe({ { { 0, 0 }, { 0.5f, 0.5f }, slate, 0.03f }, { { 0.5f, 0 }, { 1, 0.5f }, slate, 0.03f },
                             { { 0.0f, 0.5f }, { 1, 1 }, slate * 0.9f, 0.03f } },
                { .wear = 0.6f, .seed = 49 }) },
        { "vkpt/metal_chrome", 128, brushed_metal({ 0.68f, 0.69f, 0.70f }, 0.10f, 51) },
        { "vkpt/metal_copper", 128, brushed_metal({ 0.70f, 0.45f, 0.31f }, 0.16f, 53) },
        { "vkpt/metal_gold", 128, brushed_metal({ 0.76f, 0.60f, 0.30f }, 0.14f, 55) },
        { "vkpt/metal_rust", 256, rusty_metal() },
        { "vkpt/crate_teal", 128, crate({ 0.20f, 0.44f, 0.46f }, "VK-7", 57) },
        { "vkpt/crate_amber", 128, crate({ 0.62f, 0.42f, 0.16f }, "PT-9", 59) },
        { "vkpt/door", 128,
            plate_recipe({ { { 0, 0 }, { 1, 0.12f }, amber * 0.85f },
                             { { 0, 0.12f }, { 0.5f, 0.56f }, { 0.42f, 0.46f, 0.5f }, 0.06f, 1.5f },
                             { { 0.5f, 0.12f }, { 1, 0.56f }, { 0.42f, 0.46f, 0.5f }, 0.06f, 1.5f },
                             { { 0, 0.56f }, { 1, 0.88f }, slate, 0.05f, 1.2f }, { { 0, 0.88f }, { 1, 1 }, gunmetal } },
                { .bevel = 0.02f, .cut = 0.06f, .wear = 0.7f, .seed = 63 }) },
        { "vkpt/sign_lab", 128, sign("LAB 3", { 0.92f, 0.66f, 0.2f }) },
        { "vkpt/sign_pool", 128, sign("POOL", { 0.3f, 0.75f, 0.8f }) },
        { "vkpt/sign_yard", 128, sign("YARD", { 0.85f, 0.4f, 0.25f }) },
        { "vkpt/sign_core", 128, sign("CORE", { 0.9f, 0.25f, 0.18f }) },
    };
}

} // namespace vkpt::tools
