// SPDX-License-Identifier: GPL-2.0-or-later
// Temporal anti-aliasing: where in their pixels the camera rays of a frame pass.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

namespace vkpt {

// Of the frame with this number. Fewer rendered pixels have more places each, so that all pixels of the result get
// their samples.
glm::vec2 offset_in_pixel(uint32_t index, glm::uvec2 rendered, glm::uvec2 resolved);

} // namespace vkpt
