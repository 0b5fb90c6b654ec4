// SPDX-License-Identifier: GPL-2.0-or-later
// Unit vectors in 2 x 16 bit snorm, x in the low half, as shaders/lib/packing.glsl does (the octahedral map).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace vkpt {

// GLSL's sign() is 0 at 0; the map needs +1 there.
inline glm::vec2 octahedral_signs(glm::vec2 p) { return { p.x >= 0 ? 1.f : -1.f, p.y >= 0 ? 1.f : -1.f }; }

// A vector without direction gives +z.
inline uint32_t encode_octahedral(glm::vec3 direction)
{
    const float length = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
    const glm::vec3 d = length > 1e-12f && length < 1e30f ? direction / length : glm::vec3(0, 0, 1);
    glm::vec2 p(d.x, d.y);
    if (d.z < 0)
        p = (glm::vec2(1) - glm::abs(glm::vec2(p.y, p.x))) * octahedral_signs(p);
    const auto pack = [](float x) { // to the nearest; the conversion cuts off
        return uint32_t(uint16_t(int16_t(int(std::clamp(x, -1.f, 1.f) * 32767 + (x < 0 ? -0.5f : 0.5f)))));
    };
    return pack(p.x) | pack(p.y) << 16;
}

inline glm::vec3 decode_octahedral(uint32_t bits)
{
    const auto unpack = [](uint32_t half) { return std::max(float(int16_t(uint16_t(half))) / 32767, -1.f); };
    const glm::vec2 p(unpack(bits & 0xffff), unpack(bits >> 16));
    glm::vec3 direction(p, 1 - std::abs(p.x) - std::abs(p.y));
    if (direction.z < 0) {
        const glm::vec2 folded = (glm::vec2(1) - glm::abs(glm::vec2(p.y, p.x))) * octahedral_signs(p);
        direction = glm::vec3(folded, direction.z);
    }
    return glm::normalize(direction);
}

} // namespace vkpt
