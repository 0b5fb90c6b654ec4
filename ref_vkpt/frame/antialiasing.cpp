// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/antialiasing.hpp"

#include "shaders/shared/frame.h"

#include <algorithm>

namespace vkpt {

namespace {

// Halton's sequence (radical inverse of index + 1).
float halton(uint32_t index, uint32_t base)
{
    float value = 0, digit = 1;
    for (uint32_t rest = index + 1; rest > 0; rest /= base) {
        digit /= float(base);
        value += digit * float(rest % base);
    }
    return value;
}

glm::vec2 halton_place(uint32_t index) { return { halton(index, 2), halton(index, 3) }; }

} // namespace

glm::vec2 offset_in_pixel(uint32_t index, glm::uvec2 rendered, glm::uvec2 resolved)
{
    const uint64_t pixels = std::max<uint64_t>(1, uint64_t(rendered.x) * rendered.y);
    constexpr uint64_t least = shared::OFFSETS_PER_PIXEL, most = 16 * least;
    const uint64_t places = least * resolved.x * resolved.y / pixels;
    const auto count = uint32_t(std::clamp(places, least, most));
    glm::vec2 mean { 0 };
    for (uint32_t i = 0; i < count; i++)
        mean += halton_place(i) / float(count);
    return halton_place(index % count) - mean + 0.5f;
}

} // namespace vkpt
