// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/asset_generator/canvas.hpp"
#include "tools/asset_generator/noise.hpp"
#include "tools/asset_generator/surface.hpp"

#include "formats/bsp.hpp"

#include <array>
#include <cmath>

namespace vkpt::tools {

namespace {
using namespace formats;

constexpr glm::vec3 housing { 0.20f, 0.21f, 0.23f };

glm::vec3 lit(glm::vec3 colour, float amount) { return glm::min(glm::mix(colour * 0.55f, colour, amount), 1.0f); }

// Four diffuser panes in a frame.
Recipe pane_light(glm::vec3 colour)
{
    return [=](glm::vec2 uv) {
        const float frame = wrapped_box(uv, glm::vec2(0.05f), glm::vec2(0.95f));
        const glm::vec2 q = glm::fract(uv * 2.0f) - 0.5f;
        const float bar = 0.5f - std::max(std::abs(q.x), std::abs(q.y));
        if (frame > 0)
            return Surface { housing * (0.8f + 4 * frame), 1.2f };
        if (bar < 0.03f)
            return Surface { lit(colour, 0.35f), 0.8f };
        const float prism = 0.5f + 0.5f * std::cos(uv.x * 6.2831853f * 24) * std::cos(uv.y * 6.2831853f * 24);
        const float centre = 1.0f - glm::dot(q, q) * 0.8f;
        return Surface { lit(colour, glm::clamp(centre * 0.92f + prism * 0.08f, 0.0f, 1.0f)), 0 };
    };
}

// Two tubes along u behind a grille.
Recipe strip_light(glm::vec3 colour)
{
    return [=](glm::vec2 uv) {
        const float tube = std::min(std::abs(uv.y - 0.32f), std::abs(uv.y - 0.68f));
        if (std::abs(uv.y - 0.5f) > 0.44f)
            return Surface { housing, 1.0f };
        if (tube < 0.11f)
            return Surface { lit(colour, 1.0f - tube * 2.0f), std::sqrt(0.0121f - tube * tube) * 6 };
        return Surface { colour * (0.62f - tube), 0 };
    };
}

// A round lamp in a square plate.
Recipe lamp_light(glm::vec3 colour)
{
    return [=](glm::vec2 uv) {
        const float r = glm::length(uv - 0.5f);
        if (r > 0.45f) {
            const std::array plate { Plate { glm::vec2(0), glm::vec2(1), { 0.3f, 0.31f, 0.33f }, 0.07f } };
            return plates(uv, plate, { .wear = 0.5f, .seed = 301 });
        }
        if (r > 0.40f)
            return Surface { housing * 1.6f, 1.6f };
        const float ripple = 0.5f + 0.5f * std::cos(r * 90);
        return Surface { lit(colour, glm::clamp(1.05f - r * 0.9f - ripple * 0.08f, 0.0f, 1.0f)), ripple * 0.2f };
    };
}

// Three warning lamps; `on` (0-3, 3: none) is the one that shines.
Recipe blinker(int on)
{
    return [=](glm::vec2 uv) {
        const std::array plate { Plate { glm::vec2(0), glm::vec2(1), { 0.26f, 0.27f, 0.29f }, 0.06f } };
        Surface s = plates(uv, plate, { .wear = 0.5f, .seed = 311 });
        for (int i = 0; i < 3; i++) {
            const float d = glm::length(uv - glm::vec2(0.2f + 0.3f * float(i), 0.5f));
            if (d < 0.135f)
                s = { glm::vec3(0.10f), 0.6f };
            if (d < 0.115f)
                s = i == on ? Surface { glm::mix(glm::vec3(1, 0.88f, 0.5f), glm::vec3(1, 0.42f, 0.05f), d / 0.115f), 0 }
                            : Surface { glm::vec3(0.24f, 0.11f, 0.04f), 0 };
        }
        return s;
    };
}

// A monitor: text rows and a curve, drawn with light.
Recipe screen(glm::vec3 ink, uint32_t seed)
{
    return [=](glm::vec2 uv) {
        const float frame = wrapped_box(uv, glm::vec2(0.06f, 0.08f), glm::vec2(0.94f, 0.92f));
        if (frame > 0)
            return Surface { housing * (0.9f + 3 * frame), 1.5f };
        float light = 0.10f + 0.05f * std::sin(uv.y * 6.2831853f * 64);
        const int row = int(uv.y * 20);
        const float word = hash_unit(int(uv.x * 28), row, seed);
        const bool text_zone = uv.x < 0.52f && uv.y > 0.14f && uv.y < 0.84f && uv.x > 0.1f;
        if (text_zone && (row & 1) && uv.x < 0.14f + 0.38f * hash_unit(row, 5, seed) && word > 0.25f)
            light = 0.85f;
        const float x = (uv.x - 0.56f) / 0.34f;
        if (x > 0 && x < 1) {
            const float curve = 0.5f - 0.2f * std::sin(x * 9 + float(seed)) * std::exp(-x) - 0.1f * x;
            light = std::max(light, glm::smoothstep(0.014f, 0.004f, std::abs(uv.y - curve)));
            if (std::abs(uv.y - 0.8f) < 0.004f || glm::fract(x * 5) < 0.03f)
                light = std::max(light, 0.3f);
        }
        return Surface { glm::min(ink * light + light * light * 0.15f, 1.0f), 0 };
    };
}
}

std::vector<Texture> emissive_textures()
{
    struct Tone {
        const char* name;
        glm::vec3 colour;
    };
    constexpr std::array tones {
        Tone { "white", { 1.0f, 0.98f, 0.94f } },
        Tone { "warm", { 1.0f, 0.80f, 0.52f } },
        Tone { "amber", { 1.0f, 0.56f, 0.12f } },
        Tone { "red", { 1.0f, 0.16f, 0.10f } },
        Tone { "green", { 0.30f, 1.0f, 0.38f } },
        Tone { "cyan", { 0.24f, 0.92f, 1.0f } },
        Tone { "blue", { 0.22f, 0.42f, 1.0f } },
        Tone { "magenta", { 1.0f, 0.24f, 0.82f } },
    };
    std::vector<Texture> list;
    for (const Tone& tone : tones) {
        const std::string name = tone.name;
        list.push_back({ "vkpt/light_" + name, 128, pane_light(tone.colour), SURF_LIGHT, 0, 1200 });
        list.push_back({ "vkpt/strip_" + name, 64, strip_light(tone.colour), SURF_LIGHT, 0, 2000 });
        list.push_back({ "vkpt/lamp_" + name, 64, lamp_light(tone.colour), SURF_LIGHT, 0, 3000 });
    }
    for (int i = 0; i < 4; i++)
        list.push_back({ "vkpt/blink" + std::to_string(i + 1), 64, blinker(i), SURF_LIGHT, 0, i < 3 ? 900 : 60,
            "vkpt/blink" + std::to_string((i + 1) % 4 + 1) });
    list.push_back({ "vkpt/screen_a1", 128, screen({ 0.3f, 0.95f, 0.9f }, 3), SURF_LIGHT, 0, 260, "vkpt/screen_a2" });
    list.push_back({ "vkpt/screen_a2", 128, screen({ 0.3f, 0.95f, 0.9f }, 8), SURF_LIGHT, 0, 260, "vkpt/screen_a1" });
    list.push_back({ "vkpt/screen_b", 128, screen({ 1.0f, 0.6f, 0.2f }, 5), SURF_LIGHT, 0, 260 });
    return list;
}

} // namespace vkpt::tools
