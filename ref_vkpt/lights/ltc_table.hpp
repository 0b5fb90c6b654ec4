// SPDX-License-Identifier: GPL-2.0-or-later
// Linearly transformed cosines of the specular lobe, for weighing lights. Layout: shaders/shared/ltc.h.
#pragma once

#include "shaders/shared/ltc.h"

#include <array>

namespace vkpt {

inline constexpr size_t ltc_table_size = size_t(shared::LTC_SIZE) * shared::LTC_SIZE * shared::LTC_VALUES;
extern const std::array<float, ltc_table_size> ltc_table;

} // namespace vkpt
