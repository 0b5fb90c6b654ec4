// SPDX-License-Identifier: GPL-2.0-or-later
// The last view's scene as plain tables, so that other renderers can check ours.
#pragma once

#include "ref_vkpt/extension.hpp"
#include "ref_vkpt/module.hpp"

namespace vkpt {

// The tables live until the next call. The snapshot has a world.
SceneContents read_scene_contents(Module& m);

// Of all emitters: pi * area * radiance each, as all shine evenly to all sides of their front.
glm::dvec3 emitted_power(const SceneSnapshot& snapshot);

} // namespace vkpt
