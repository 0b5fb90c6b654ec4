// SPDX-License-Identifier: GPL-2.0-or-later
// The scene's tables as buffers of texels, for CPU drivers, which read these in half the time of buffer references
// (docs/notes/cpu-driver.md). GPUs read the tables by address; there every buffer of texels is an empty one.
#pragma once

#include "ref_vkpt/vulkan/bindings.hpp"
#include "ref_vkpt/vulkan/swapchain.hpp"
#include "ref_vkpt/vulkan/texel_set.hpp"
#include "shaders/shared/texels.h"

#include <array>
#include <cstdint>

namespace vkpt {

// Of one view.
class SceneTexels {
public:
    using Tables = std::array<const Buffer*, shared::TEXELS_COUNT>; // by TEXELS_*

    SceneTexels(const Gpu& gpu, const Bindings& bindings);

    // Where shaders read texels: once a frame, after the tables have got their memory. The device has finished with
    // this slot. nullptr: an empty table.
    void bind(uint32_t frame_slot, const Tables& tables);

    // For set 2, see bindings.hpp.
    VkDescriptorSet set(uint32_t frame_slot) const { return slots_[frame_slot].handle(); }

private:
    Gpu gpu_;
    std::array<TexelSet, frames_in_flight> slots_;
};

} // namespace vkpt
