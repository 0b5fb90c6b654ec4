// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "formats/image.hpp"

#include <vector>

namespace vkpt {

// A picture of one colour.
inline formats::Image make_plain(int width, int height, formats::Rgba8 colour)
{
    return { width, height, std::vector<formats::Rgba8>(size_t(width * height), colour) };
}

} // namespace vkpt
