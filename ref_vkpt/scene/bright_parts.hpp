// SPDX-License-Identifier: GPL-2.0-or-later
// Which parts of a texture shine, if its surface does: the lamps in a panel.
#pragma once

#include "formats/image.hpp"
#include "ref_vkpt/lights/face_pieces.hpp"
#include "ref_vkpt/scene/texture_files.hpp"

#include <vector>

namespace vkpt {

// Rectangles that do not overlap, around what is at least 0.3 times as bright as the brightest spot. None where they
// would be more than four, cover more than half of the texture, or hold less than 0.6 of its light: it shines all over,
// then.
std::vector<BrightPart> find_bright_parts(const formats::Image& image, AlphaMeaning alpha = AlphaMeaning::opacity);

// Texels whose greatest component is below `threshold` (1 to 255) become black.
formats::Image keep_bright_texels(formats::Image image, int threshold);

} // namespace vkpt
