// SPDX-License-Identifier: GPL-2.0-or-later
// The lights of one view of a map: its dynamic ones, each with an index that it keeps, and the lists that they are in.
#pragma once

#include "ref_vkpt/lights/dynamic_lights.hpp"
#include "ref_vkpt/lights/light_lists.hpp"

namespace vkpt {

struct ViewLights {
    DynamicLights dynamic;
    LightLists lists; // at first a copy of the map's
    bool said_unlisted = false; // that some found no room there
};

} // namespace vkpt
