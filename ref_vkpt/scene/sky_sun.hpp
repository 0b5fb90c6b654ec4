// SPDX-License-Identifier: GPL-2.0-or-later
// The sun that is painted on a sky's textures.
#pragma once

#include "formats/image.hpp"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace vkpt {

struct PaintedSun {
    glm::vec2 centre; // (-1, -1) left top .. (1, 1) right bottom
    glm::vec3 colour; // linear, of its brightest part
};

// The one small spot that is far brighter than the rest of the texture. Nothing where there is none, or several.
std::optional<PaintedSun> find_painted_sun(const formats::Image& image);

// Unit, in the sky's space, of a place on side 0 to 5: +x, -x, +y, -y, +z, -z. The inverse of sky_face
// (shaders/lib/sky.glsl).
glm::vec3 direction_on_sky(size_t side, glm::vec2 place);

} // namespace vkpt
