// SPDX-License-Identifier: GPL-2.0-or-later
// The console typeface: 16 x 16 cells of 8 x 8 pixels.
#pragma once

#include "formats/image.hpp"

namespace vkpt::tools {

// Codes 0-127 in white and frames, 128-255 the same letters in amber; the codes that the engine's menus and console
// draw directly hold box, field, slider and cursor pieces.
formats::IndexedImage make_character_sheet();

} // namespace vkpt::tools
