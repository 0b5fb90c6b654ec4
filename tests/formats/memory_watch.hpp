// SPDX-License-Identifier: GPL-2.0-or-later
// How much memory C++ code of this program holds at most: operator new is counted.
#pragma once

#include <cstddef>

namespace vkpt::memory_watch {

void reset_peak();
size_t peak(); // bytes above what was held at the last reset

} // namespace vkpt::memory_watch
