// SPDX-License-Identifier: GPL-2.0-or-later
// env/vkpt1*.tga: dusk, the sun just above the northern horizon, lit clouds, far hills.
#include "tools/asset_generator/noise.hpp"
#include "tools/asset_generator/output.hpp"

#include "formats/image.hpp"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <string>

namespace vkpt::tools {

namespace {
const glm::vec3 sun_direction = glm::normalize(glm::vec3(0.065f, 0.95f, 0.19f));

// Which world direction a picture's right, its up and its view axis are; the order of the engine's sky sides.
struct Side {
    const char* suffix;
    glm::vec3 forward, right, up;
};
constexpr std::array sides {
    Side { "rt", { 1, 0, 0 }, { 0, -1, 0 }, { 0, 0, 1 } },
    Side { "bk", { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, 1 } },
    Side { "lf", { -1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
    Side { "ft", { 0, -1, 0 }, { -1, 0, 0 }, { 0, 0, 1 } },
    Side { "up", { 0, 0, 1 }, { 0, -1, 0 }, { -1, 0, 0 } },
    Side { "dn", { 0, 0, -1 }, { 0, -1, 0 }, { 1, 0, 0 } },
};

glm::vec3 air_colour(glm::vec3 d, float toward_sun)
{
    const float height = std::max(d.z, 0.0f);
    const glm::vec3 zenith(0.09f, 0.15f, 0.33f), middle(0.36f, 0.34f, 0.50f);
    const glm::vec3 horizon = glm::mix(glm::vec3(0.46f, 0.36f, 0.44f), glm::vec3(0.98f, 0.62f, 0.34f), toward_sun);
    return glm::mix(
        glm::mix(horizon, middle, glm::smoothstep(0.0f, 0.36f, height)), zenith, glm::smoothstep(0.25f, 0.95f, height));
}

glm::vec3 add_clouds(glm::vec3 sky, glm::vec3 d, float toward_sun)
{
    if (d.z < 0.02f)
        return sky;
    const glm::vec2 p = glm::vec2(d.x, d.y) / (d.z + 0.12f) * 0.06f; // a flat layer, seen in perspective
    const glm::vec2 uv = glm::fract(p + 0.5f);
    const float thick = fractal_noise(uv, { 9, 6 }, 6, 701);
    const float ahead = fractal_noise(glm::fract(uv + glm::vec2(sun_direction) * 0.012f), { 9, 6 }, 5, 701);
    const float cover = glm::smoothstep(0.47f, 0.66f, thick) * glm::smoothstep(0.02f, 0.16f, d.z);
    const float lit = glm::clamp(0.5f + (thick - ahead) * 6.0f, 0.0f, 1.0f); // the side towards the sun
    const glm::vec3 shadow = glm::mix(glm::vec3(0.25f, 0.22f, 0.34f), glm::vec3(0.50f, 0.26f, 0.26f), toward_sun);
    const glm::vec3 glow = glm::mix(glm::vec3(0.80f, 0.56f, 0.56f), glm::vec3(1.0f, 0.76f, 0.46f), toward_sun);
    return glm::mix(sky, glm::mix(shadow, glow, lit), cover * 0.85f);
}

glm::vec3 sky_colour(glm::vec3 d)
{
    const float cosine = glm::dot(d, sun_direction);
    const float toward_sun = glm::smoothstep(-0.3f, 1.0f, cosine);
    glm::vec3 colour = add_clouds(air_colour(d, toward_sun * toward_sun), d, toward_sun * toward_sun);
    colour += glm::vec3(1.0f, 0.62f, 0.28f) * (0.55f * std::pow(std::max(cosine, 0.0f), 60.0f));
    colour += glm::vec3(1.0f, 0.90f, 0.70f) * glm::smoothstep(0.9984f, 0.9992f, cosine);
    if (d.z > 0.3f) { // first stars, where it is dark
        const glm::vec2 cell = glm::vec2(d.x, d.y) / (1 + d.z) * 220.0f;
        const int x = int(std::floor(cell.x)), y = int(std::floor(cell.y));
        const glm::vec2 at = glm::vec2(x, y) + 0.5f;
        if (hash_unit(x, y, 711) > 0.985f)
            colour += 0.5f * glm::smoothstep(0.4f, 0.0f, glm::length(cell - at)) * (1 - toward_sun);
    }
    const float angle = std::atan2(d.y, d.x) / 6.2831853f + 0.5f;
    const float hills = 0.02f + 0.13f * fractal_noise({ angle, 0.31f }, { 14, 2 }, 5, 721);
    if (d.z < hills) {
        const glm::vec3 near(0.07f, 0.07f, 0.10f), haze(0.30f, 0.22f, 0.26f);
        colour = glm::mix(near, haze, glm::smoothstep(-0.05f, hills, d.z) * (0.4f + 0.6f * toward_sun));
    }
    return glm::clamp(colour, 0.0f, 1.0f);
}
}

void write_sky(const Output& out)
{
    constexpr int size = 512;
    for (const Side& side : sides) {
        formats::Image image { size, size, {} };
        image.pixels.reserve(size_t(size) * size);
        for (int y = 0; y < size; y++) {
            for (int x = 0; x < size; x++) {
                const float s = 2 * (float(x) + 0.5f) / size - 1, t = 1 - 2 * (float(y) + 0.5f) / size;
                const glm::vec3 c
                    = sky_colour(glm::normalize(side.forward + side.right * s + side.up * t)) * 255.0f + 0.5f;
                image.pixels.push_back({ uint8_t(c.x), uint8_t(c.y), uint8_t(c.z), 255 });
            }
        }
        out.write("env/vkpt1" + std::string(side.suffix) + ".tga", formats::write_tga(image));
    }
}

} // namespace vkpt::tools
