// SPDX-License-Identifier: GPL-2.0-or-later
// What a camera would see between two recorded views, for motion blur.
#pragma once

#include "common/trace/calls.hpp"

namespace vkpt::trace {

// `share` 0: `before`, 1: `after`. Things that only one of the two has are those of the nearer one. A cut (another map,
// a teleport) has nothing in between: then the nearer one is shown.
View blend_views(const View& before, const View& after, float share);

} // namespace vkpt::trace
