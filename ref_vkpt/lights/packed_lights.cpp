// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/packed_lights.hpp"

#include "common/colour.hpp"
#include "ref_vkpt/lights/octahedral.hpp"
#include "ref_vkpt/lights/spot_cone.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vkpt {

namespace {

// The highest `bits` of a float's, rounded.
uint32_t shorten_float(float value, uint32_t bits)
{
    const uint32_t half = 1u << (31 - bits);
    return (std::bit_cast<uint32_t>(value) + half) & (~0u << (32 - bits));
}

// The biased exponent of the least power of two that is no less than any component.
uint32_t exponent_above(const glm::vec3& a, const glm::vec3& b)
{
    const glm::vec3 sides = glm::max(glm::abs(a), glm::abs(b));
    const uint32_t side = std::bit_cast<uint32_t>(std::max({ sides.x, sides.y, sides.z }));
    return (side + 0x7fffffu) >> 23;
}

uint32_t pack_cosine(float cosine)
{
    return uint32_t(uint16_t(int16_t(std::lround(std::clamp(cosine, -1.0f, 1.0f) * 32767))));
}

} // namespace

shared::PackedLight pack_light_shape(const shared::Emitter& emitter, float lightstyle)
{
    const uint32_t radiance = std::bit_cast<uint32_t>(std::abs(luminance(emitter.radiance * lightstyle)))
        & shared::PACKED_LIGHT_RADIANCE_MASK;
    if (is_sphere(emitter)) {
        shared::PackedLight sphere { emitter.p0, radiance | 0x80000000u,
            { std::bit_cast<uint32_t>(emitter.p1.x), std::bit_cast<uint32_t>(emitter.reach), 0, 0 } };
        if (has_cone(emitter)) {
            sphere.shape[2] = encode_octahedral(emitter.p2);
            sphere.shape[3] = pack_cosine(emitter.p1.z) | pack_cosine(outer_cosine(emitter) - shared::CONE_SLACK) << 16;
        }
        return sphere;
    }
    const glm::vec3 first = emitter.p1 - emitter.p0, second = emitter.p2 - emitter.p0;
    constexpr uint32_t bits = shared::PACKED_LIGHT_BITS, more_bits = shared::PACKED_LIGHT_MORE_BITS,
                       left = (1u << (32 - bits)) - 1;
    const uint32_t y = shorten_float(second.y, more_bits), z = shorten_float(second.z, more_bits);
    return { emitter.p0, radiance | exponent_above(first, second),
        { shorten_float(first.x, bits) | y >> bits, shorten_float(first.y, bits) | (y >> (32 - more_bits) & left),
            shorten_float(first.z, bits) | z >> bits,
            shorten_float(second.x, bits) | (z >> (32 - more_bits) & left) } };
}

PackedLightWriter::PackedLightWriter(std::span<const shared::Emitter> emitters)
{
    for (uint32_t i = 0; i < emitters.size(); i++) {
        const size_t style = emitters[i].lightstyle;
        emitters_of_style_.resize(std::max(emitters_of_style_.size(), style + 1));
        emitters_of_style_[style].push_back(i);
    }
}

size_t PackedLightWriter::update(shared::PackedLight* target, std::vector<float>& held,
    std::span<const shared::Emitter> emitters, std::span<const float> scales) const
{
    size_t written = 0;
    for (size_t style = 0; style < emitters_of_style_.size(); style++) {
        if (style < held.size() && held[style] == scales[style])
            continue;
        for (const uint32_t i : emitters_of_style_[style])
            target[i] = pack_light_shape(emitters[i], scales[style]);
        written += emitters_of_style_[style].size();
    }
    held.assign(scales.begin(), scales.end());
    return written;
}

void write_packed_lights(
    shared::PackedLight* target, size_t count, std::span<const shared::Emitter> emitters, std::span<const float> scales)
{
    const auto packed = [&](const shared::Emitter& e) { return pack_light_shape(e, scales[e.lightstyle]); };
    auto* const end = std::ranges::transform(emitters, target, packed).out;
    std::fill(end, target + count, shared::PackedLight {});
}

} // namespace vkpt
