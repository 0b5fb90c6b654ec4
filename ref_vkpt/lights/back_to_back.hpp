// SPDX-License-Identifier: GPL-2.0-or-later
// Faces in one plane that look away from each other: shells of what is not solid, such as windows, mist and liquids,
// whose sides a map has twice, once to be seen from outside and once from inside.
#pragma once

#include "formats/bsp.hpp"

#include <vector>

namespace vkpt {

// For each face whether another one of its model, in its plane and the other way round, covers a part of it. Those that
// are not drawn do not count. Looks at so many pairs at most as is right for a map of its size, and says no of what is
// left then.
std::vector<bool> find_back_to_back(const formats::Bsp& bsp);

} // namespace vkpt
