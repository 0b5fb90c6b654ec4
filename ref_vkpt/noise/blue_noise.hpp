// SPDX-License-Identifier: GPL-2.0-or-later
// The blue-noise masks that shaders/lib/random.glsl looks up, made during the build by tools/blue_noise.
#pragma once

#include "shaders/shared/noise.h"

#include <array>
#include <cstdint>

namespace vkpt {

extern const std::array<uint32_t, shared::BLUE_NOISE_WORDS> blue_noise_words; // layout: shaders/shared/noise.h

} // namespace vkpt
