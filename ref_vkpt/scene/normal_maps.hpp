// SPDX-License-Identifier: GPL-2.0-or-later
// Normal maps as shaders read them. No engine, no GPU.
#pragma once

#include "formats/image.hpp"

#include <vector>

namespace vkpt {

// All mip levels of a normal map, down to one texel. A file's texel holds a direction as x, y, z = (c - 128) / 127 (x
// along the texture's u, y along its v, downwards, z out of the surface) and metalness as alpha. A texel made of it has
// r, g: x and y of the mean unit normal's direction, in 1 / 127 from 128; z is above 0,
// b: sqrt of the variance of the slope along each axis, (1 - l) / l at a mean of length l (Toksvig 2005), in 1 / 255,
// a: mean metalness.
// Directions that point into the surface, or nowhere, become flat ones.
std::vector<formats::Image> make_normal_levels(const formats::Image& image);

} // namespace vkpt
