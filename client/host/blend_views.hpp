// SPDX-License-Identifier: GPL-2.0-or-later
// What a camera would see between two recorded views, for motion blur.
#pragma once

#include "client/trace/calls.hpp"

namespace vkpt::client {

// `share` 0: `before`, 1: `after`. Things that only one of the two has are those of the nearer one. A cut (another map,
// a teleport) has nothing in between: then the nearer one is shown.
trace::View blend_views(const trace::View& before, const trace::View& after, float share);

} // namespace vkpt::client
