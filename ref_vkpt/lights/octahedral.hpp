// SPDX-License-Identifier: GPL-2.0-or-later
// Unit vectors in 2 x 16 bit snorm by the octahedral map, x in the low half, as shaders/lib/packing.glsl does.
#pragma once

#include "shaders/shared/octahedral.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vkpt {

// A vector without direction gives +z.
inline uint32_t encode_octahedral(glm::vec3 direction)
{
    const float length = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
    const bool has_direction = length > 1e-12f && length < 1e30f;
    const glm::vec2 p = shared::direction_to_octahedron(has_direction ? direction : glm::vec3(0, 0, 1));
    const auto pack = [](float x) { // to the nearest; the conversion cuts off
        return uint32_t(uint16_t(int16_t(int(std::clamp(x, -1.f, 1.f) * 32767 + (x < 0 ? -0.5f : 0.5f)))));
    };
    return pack(p.x) | pack(p.y) << 16;
}

inline glm::vec3 decode_octahedral(uint32_t bits)
{
    const auto unpack = [](uint32_t half) { return std::max(float(int16_t(uint16_t(half))) / 32767, -1.f); };
    return shared::octahedron_to_direction({ unpack(bits & 0xffff), unpack(bits >> 16) });
}

} // namespace vkpt
