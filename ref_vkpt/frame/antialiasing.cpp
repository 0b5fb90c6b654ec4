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

} // namespace

glm::vec2 offset_in_pixel(uint32_t index, glm::uvec2 rendered, glm::uvec2 resolved)
{
    const uint64_t pixels = std::max<uint64_t>(1, uint64_t(rendered.x) * rendered.y);
    constexpr uint64_t least = shared::OFFSETS_PER_PIXEL, most = 16 * least;
    const uint64_t places = least * resolved.x * resolved.y / pixels;
    index = uint32_t(index % std::clamp(places, least, most));
    return { halton(index, 2), halton(index, 3) };
}

} // namespace vkpt
