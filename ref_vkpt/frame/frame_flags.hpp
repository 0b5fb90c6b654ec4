// SPDX-License-Identifier: GPL-2.0-or-later
// Which FRAME_* flags the settings ask for: with them the passes of a view are chosen (pass_rows.hpp), before it is
// recorded and, to compile ahead, long before.
#pragma once

#include <cstdint>

namespace vkpt {

// Of the filters of a live view of a world, by the present settings.
uint32_t filter_flags();
// Those, bloom, and what a live view of a world may have beside.
uint32_t possible_flags();
// Whether the settings let bounce rays use the light cache.
bool uses_light_cache();
// Whether they correct what they read there, so that averaged images may read it, too.
bool corrects_light_cache();

} // namespace vkpt
