// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/surface.hpp"

#include "tools/asset_generator/noise.hpp"

#include <algorithm>
#include <cmath>

namespace vkpt::tools {

namespace {
glm::vec2 wrap_difference(glm::vec2 d) { return d - glm::round(d); }

float chamfered(glm::vec2 uv, const Plate& plate, const PlateStyle& style)
{
    const glm::vec2 half = (plate.high - plate.low) * 0.5f - style.gap;
    const glm::vec2 q = glm::abs(wrap_difference(uv - (plate.low + plate.high) * 0.5f)) - half;
    return std::max({ q.x, q.y, (q.x + q.y + style.cut) * 0.7071f });
}

// A round bolt head near each corner: colour and height change.
void add_bolts(Surface& surface, glm::vec2 uv, const Plate& plate)
{
    constexpr float radius = 0.011f;
    for (int corner = 0; corner < 4; corner++) {
        const glm::vec2 at(corner & 1 ? plate.high.x - plate.bolt_inset : plate.low.x + plate.bolt_inset,
            corner & 2 ? plate.high.y - plate.bolt_inset : plate.low.y + plate.bolt_inset);
        const float d = wrapped_distance(uv, at) / radius;
        if (d < 1.35f)
            surface.colour *= 0.55f; // shadow line around the head
        if (d < 1) {
            surface.colour = glm::vec3(0.46f, 0.47f, 0.48f);
            surface.height += 0.7f * std::sqrt(1 - d * d);
        }
    }
}
}

float wrapped_box(glm::vec2 uv, glm::vec2 low, glm::vec2 high)
{
    const glm::vec2 q = glm::abs(wrap_difference(uv - (low + high) * 0.5f)) - (high - low) * 0.5f;
    return glm::length(glm::max(q, 0.0f)) + std::min(std::max(q.x, q.y), 0.0f);
}

float wrapped_distance(glm::vec2 uv, glm::vec2 point) { return glm::length(wrap_difference(uv - point)); }

glm::vec3 hue_shift(glm::vec3 colour, float amount) { return glm::clamp(colour * (1.0f + amount), 0.0f, 1.0f); }

Surface plates(glm::vec2 uv, std::span<const Plate> list, const PlateStyle& style)
{
    Surface surface { style.gap_colour, 0 };
    const float cloud = fractal_noise(uv, 4, 5, style.seed);
    const float fine = fractal_noise(uv, 48, 3, style.seed + 7);
    const float streak = fractal_noise(uv, { 40, 3 }, 4, style.seed + 13); // runs downwards
    for (size_t i = 0; i < list.size(); i++) {
        const Plate& plate = list[i];
        const float d = chamfered(uv, plate, style);
        if (d >= 0)
            continue;
        const float rise = glm::smoothstep(0.0f, style.bevel, -d);
        const float tint = hash_unit(int(i), 3, style.seed) - 0.5f;
        glm::vec3 colour = hue_shift(plate.colour, 0.08f * tint + style.grain * (fine - 0.5f) * 2.0f);
        colour *= 1.0f - style.wear * 0.45f * glm::smoothstep(0.45f, 0.75f, cloud);
        colour *= 1.0f - style.wear * 0.35f * glm::smoothstep(0.5f, 0.8f, streak);
        const float chip = glm::smoothstep(0.03f, 0.0f, -d) * glm::smoothstep(0.52f, 0.66f, fine * 0.5f + cloud * 0.5f);
        colour = glm::mix(colour, glm::vec3(0.42f, 0.41f, 0.4f), chip * style.wear);
        colour *= 0.72f + 0.28f * glm::smoothstep(0.0f, style.bevel * 2.5f, -d); // dirt gathers along the rim
        surface.colour = colour;
        surface.height = plate.lift * rise;
        if (plate.bolt_inset > 0)
            add_bolts(surface, uv, plate);
    }
    return surface;
}

std::vector<glm::vec3> render_surface(const Recipe& recipe, int size)
{
    const auto at
        = [size](int x, int y) { return size_t((y + size) % size) * size_t(size) + size_t((x + size) % size); };
    std::vector<Surface> samples(size_t(size) * size_t(size));
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++)
            samples[at(x, y)] = recipe((glm::vec2(x, y) + 0.5f) / float(size));
    std::vector<glm::vec3> colours(samples.size());
    const float to_pixels = float(size) / 64.0f; // heights in pixels, so that slopes are slopes
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            const float dx = (samples[at(x + 1, y)].height - samples[at(x - 1, y)].height) * 0.5f * to_pixels;
            const float dy = (samples[at(x, y + 1)].height - samples[at(x, y - 1)].height) * 0.5f * to_pixels;
            const float lit = glm::clamp(1.0f + 0.18f * dx + 0.26f * dy, 0.6f, 1.35f); // light from above left
            colours[at(x, y)] = glm::clamp(samples[at(x, y)].colour * lit, 0.0f, 1.0f);
        }
    }
    return colours;
}

} // namespace vkpt::tools
