// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace vkpt {

// Of linear sRGB; as shaders/lib/bsdf.glsl has it.
inline float luminance(glm::vec3 colour) { return glm::dot(colour, glm::vec3(0.2126f, 0.7152f, 0.0722f)); }

} // namespace vkpt
