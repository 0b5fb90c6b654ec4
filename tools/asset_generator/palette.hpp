// SPDX-License-Identifier: GPL-2.0-or-later
// Our own 256 colours, and the way from full colour to them.
#pragma once

#include "formats/image.hpp"

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

namespace vkpt::tools {

inline constexpr uint8_t transparent_index = 255;

// Colours are sRGB-encoded, 0..1, throughout this program.
const formats::Palette& game_palette();

// The nearest opaque entry.
uint8_t nearest_index(glm::vec3 colour);
// Whole pictures with ordered dither; `strength` 1 spans the palette's typical step. Alpha below one half becomes the
// transparent index where `cut_out` is set.
formats::IndexedImage quantise(
    int width, int height, std::span<const glm::vec4> pixels, float dither_strength, bool cut_out);

// pics/colormap.pcx: 64 rows of light levels (bright to dark), then the 256 x 256 table of one third-two thirds blends,
// the layout that software renderers of this family read.
formats::IndexedImage make_colormap();

} // namespace vkpt::tools
