// SPDX-License-Identifier: GPL-2.0-or-later
// Lights that the game module places, in what every demo and every client carries: an entity with one of a few models,
// whose skin number holds the light. Other renderers show the model and take a skin that it lacks for its first.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

namespace formats {

enum class LightModel {
    bulb, // a sphere's light; its mesh, a marker, shows with RF_FULLBRIGHT only
    spot, // the same within a shade, whose opening is frame spot_cones[frame] wide and looks along the entity's x axis
    flare, // at the tip of a rod
    swarm, // `count` spheres that circle the entity
};
inline constexpr std::array<std::string_view, 4> light_models {
    "models/vkpt/bulb/tris.md2",
    "models/vkpt/spot/tris.md2",
    "models/vkpt/flare/tris.md2",
    "models/vkpt/swarm/tris.md2",
};
inline constexpr std::array<int, 8> spot_cones { 15, 20, 30, 40, 50, 65, 80, 100 }; // degrees, by frame
inline constexpr float flare_tip = 6; // of its light from the rod's origin, along its x axis, units

inline std::optional<LightModel> find_light_model(std::string_view name)
{
    const auto found = std::ranges::find(light_models, name);
    if (found == light_models.end())
        return std::nullopt;
    return LightModel(found - light_models.begin());
}

enum class LightStyle : uint32_t { steady, pulse, flicker, sputter };

struct CodedLight {
    glm::vec3 colour { 1 }; // 0..1, linear
    float value = 300; // as of a map's light entity
    float radius = 4; // of the sphere, units
    LightStyle style = LightStyle::steady;
    uint32_t phase = 0; // 0..3: lights of one style differ by it
    uint32_t count = 1; // swarm: 1..16
};

// From the lowest bit on: colour 5 + 5 + 4, value 6, radius 3, style 2, phase 2, count 4. The highest bit stays clear:
// renderers index with the number.
inline constexpr std::array<float, 8> light_radii { 0.5f, 1, 1.5f, 2, 4, 6, 10, 16 };
inline constexpr float min_light_value = 25, light_values_per_octave = 10;
inline constexpr uint32_t max_in_swarm = 16;

inline int32_t encode_light(const CodedLight& light)
{
    const auto part = [](float share, uint32_t most) {
        // Square roots: eyes tell dark shades apart better than bright ones.
        return uint32_t(std::lround(std::sqrt(std::clamp(share, 0.0f, 1.0f)) * float(most)));
    };
    const float octaves = std::log2(std::max(light.value, min_light_value) / min_light_value);
    const uint32_t value = uint32_t(std::clamp(std::lround(octaves * light_values_per_octave), 0l, 63l));
    uint32_t radius = 0;
    for (uint32_t i = 1; i < light_radii.size(); i++)
        if (std::abs(light_radii[i] - light.radius) < std::abs(light_radii[radius] - light.radius))
            radius = i;
    const uint32_t count = std::clamp(light.count, 1u, max_in_swarm) - 1;
    return int32_t(part(light.colour.x, 31) | part(light.colour.y, 31) << 5 | part(light.colour.z, 15) << 10
        | value << 14 | radius << 20 | (uint32_t(light.style) & 3) << 23 | (light.phase & 3) << 25 | count << 27);
}

inline CodedLight decode_light(int32_t code)
{
    const uint32_t bits = uint32_t(code);
    const auto part = [](uint32_t value, uint32_t most) {
        const float root = float(value & most) / float(most);
        return root * root;
    };
    CodedLight light;
    light.colour = { part(bits, 31), part(bits >> 5, 31), part(bits >> 10, 15) };
    light.value = min_light_value * std::exp2(float(bits >> 14 & 63) / light_values_per_octave);
    light.radius = light_radii[bits >> 20 & 7];
    light.style = LightStyle(bits >> 23 & 3);
    light.phase = bits >> 25 & 3;
    light.count = (bits >> 27 & 15) + 1;
    return light;
}

// What the style leaves of the light at a time in seconds, 0..1.
inline float light_level(LightStyle style, uint32_t phase, float time)
{
    const float shift = float(phase) * 0.25f;
    const auto noise = [&](float rate) { // 0..1, smooth
        const auto point = [&](float n) {
            uint32_t hash = uint32_t(int64_t(n)) * 747796405u + phase * 2891336453u + 277803737u;
            hash = (hash >> ((hash >> 28) + 4) ^ hash) * 277803737u;
            return float(hash >> 22 ^ (hash & 1023)) / 1023;
        };
        const float at = (time + 100 * shift) * rate, whole = std::floor(at), f = at - whole;
        return glm::mix(point(whole), point(whole + 1), f * f * (3 - 2 * f));
    };
    switch (style) {
    case LightStyle::steady:
        return 1;
    case LightStyle::pulse:
        return 0.55f + 0.45f * std::sin((time * 0.5f + shift) * 6.2831853f);
    case LightStyle::flicker:
        return 0.5f + 0.5f * noise(9);
    case LightStyle::sputter:
        return noise(1.7f) < 0.25f ? 0.15f + 0.35f * noise(17) : 0.75f + 0.25f * noise(13);
    }
    return 1;
}

// Where spheres of a swarm are, relative to the entity: within a ball of `swarm_radius` units.
inline constexpr float swarm_radius = 24;
inline glm::vec3 place_in_swarm(uint32_t number, uint32_t count, float time)
{
    if (count == 1)
        return glm::vec3(0);
    const float share = float(number) / float(count), turn = 6.2831853f;
    const float speed = 0.2f + 0.05f * float(number % 7), a = turn * (share + time * speed);
    const float tilt = turn * 0.618034f * float(number), radius = swarm_radius * (0.4f + 0.6f * share);
    const float x = std::cos(a) * radius, y = std::sin(a) * radius;
    return { x, y * std::cos(tilt), y * std::sin(tilt) };
}

} // namespace formats
