// SPDX-License-Identifier: GPL-2.0-or-later
// Suns of a map: by the worldspawn keys of ArghRad ("_sun_light", "_sun2_light" ...), or by light entities with "_sun".
#pragma once

#include "formats/entities.hpp"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vkpt {

struct Sun {
    glm::vec3 to_sun { 0, 0, 1 }; // unit
    float light = 0; // lightmap units on a surface that faces it: irradiance = pi / 128 * light
    std::optional<glm::vec3> colour; // times `light`; none: the sky's, greatest component 1
    float half_angle = 0; // radians, of the disc: shadows at distance d have penumbrae of 2 d tan(half_angle)
    uint32_t lightstyle = 0; // 0: steady
};

// As seen from the earth, degrees across.
inline constexpr float sun_diameter = 0.53f;

std::vector<Sun> find_suns(std::span<const formats::EntityText> entities);

// `sky_colour`: for suns without one; any brightness.
shared::Emitter make_sun(const Sun& sun, glm::vec3 sky_colour);

} // namespace vkpt
