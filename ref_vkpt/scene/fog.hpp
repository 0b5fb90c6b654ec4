// SPDX-License-Identifier: GPL-2.0-or-later
// Fog that a map, or maps/NAME.lights, has in boxes: entities of the class "fog_box".
#pragma once

#include "formats/entities.hpp"
#include "shaders/shared/scene.h"

#include <span>
#include <string>
#include <vector>

namespace vkpt {

// The first MAX_FOG_BOXES that make sense. Keys: "mins" and "maxs"; "density" per unit; "density2", if it is another
// one at the upper end of "axis" (x, y or z; z if it is missing); "_color", the radiance of fog that nothing is seen
// through. What is left out is named in `messages`, with `map` before it.
std::vector<shared::FogBox> find_fog_boxes(
    std::span<const formats::EntityText> entities, const std::string& map, std::vector<std::string>& messages);

} // namespace vkpt
