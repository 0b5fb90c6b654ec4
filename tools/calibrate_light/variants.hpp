// SPDX-License-Identifier: GPL-2.0-or-later
// A map with some of its kinds of light taken out, so that each kind's share of the light can be measured.
#pragma once

#include "formats/bsp.hpp"

namespace vkpt::tools {

enum class LightKind { face, point, sky };
inline constexpr size_t light_kind_count = 3;

const char* name_of(LightKind kind);

// The map with the lights of `kind` only. Plain sky (not SURF_LIGHT) is left to the renderer's own scale.
formats::Bsp keep_lights_of(const formats::Bsp& bsp, LightKind kind);

} // namespace vkpt::tools
