// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace vkpt::tools {

inline constexpr float tau = 6.2831853f; // a whole turn, radians

} // namespace vkpt::tools
