// SPDX-License-Identifier: GPL-2.0-or-later
// The scene's tables as buffers of texels, for CPU drivers, which read these in half the time of buffer references
// (docs/benchmarks.md, "The floor"). GPUs read the tables by address; there every buffer of texels is an empty one.
#pragma once

#include "ref_vkpt/vulkan/bindings.hpp"
#include "ref_vkpt/vulkan/resources.hpp"
#include "ref_vkpt/vulkan/swapchain.hpp"
#include "shaders/shared/texels.h"

#include <array>

namespace vkpt {

// Of one view.
class SceneTexels {
public:
    using Tables = std::array<const Buffer*, shared::TEXELS_COUNT>; // by TEXELS_*

    SceneTexels(const Gpu& gpu, const Bindings& bindings);
    ~SceneTexels();
    SceneTexels(const SceneTexels&) = delete;
    SceneTexels& operator=(const SceneTexels&) = delete;

    // Where shaders read texels: once a frame, after the tables have got their memory. The device has finished with
    // this slot. nullptr: an empty table.
    void bind(uint32_t frame_slot, const Tables& tables);

    // For set 2, see bindings.hpp.
    VkDescriptorSet set(uint32_t frame_slot) const { return slots_[frame_slot].set; }

private:
    struct Slot {
        VkDescriptorSet set = VK_NULL_HANDLE;
        std::array<TexelView, shared::TEXELS_COUNT> views;
    };

    Gpu gpu_;
    Buffer empty_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    std::array<Slot, frames_in_flight> slots_;
};

} // namespace vkpt
