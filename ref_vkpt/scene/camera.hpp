// SPDX-License-Identifier: GPL-2.0-or-later
// From the engine's view to ours.
#pragma once

#include "ref_vkpt/engine/contract.hpp"
#include "ref_vkpt/scene/snapshot.hpp"

#include <vulkan/vulkan_core.h>

namespace vkpt {

// `image`: the size of the whole image, to which the view's rectangle is clipped.
Viewpoint make_viewpoint(const engine::RefDef& refdef, VkExtent2D image);

} // namespace vkpt
