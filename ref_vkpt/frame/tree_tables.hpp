// SPDX-License-Identifier: GPL-2.0-or-later
// The trees of backend "software" as buffers of texels, for CPU drivers, which read these in half the time of buffer
// references (docs/benchmarks.md, "The floor"): the map's and the moving things', one behind the other. GPUs read trees by
// address, the map's from memory of their own; there the buffers hold next to nothing.
#pragma once

#include "ref_vkpt/frame/uploads.hpp"
#include "ref_vkpt/trace/bvh.hpp"
#include "ref_vkpt/vulkan/bindings.hpp"

#include <array>

namespace vkpt {

class TreeTables {
public:
    TreeTables(const Gpu& gpu, const Bindings& bindings);
    ~TreeTables();
    TreeTables(const TreeTables&) = delete;
    TreeTables& operator=(const TreeTables&) = delete;

    // For one view: `world`, copied where `version` is another one than before in this slot, and room for what moves. Addresses are
    // the world's. The device has finished with this slot. world: nullptr where there is none.
    struct Room {
        Upload nodes, triangles; // mapped: what moves
    };
    Room reserve(uint32_t frame_slot, const Bvh* world, uint64_t version, size_t nodes, size_t triangles);

    // For set 2, see bindings.hpp.
    VkDescriptorSet set(uint32_t frame_slot) const { return slots_[frame_slot].set; }

private:
    struct Slot {
        VkDescriptorSet set = VK_NULL_HANDLE;
        std::array<VkBufferView, 2> views {};
    };
    void bind(uint32_t frame_slot);

    Gpu gpu_;
    PrefixedUpload nodes_, triangles_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    std::array<Slot, frames_in_flight> slots_;
};

} // namespace vkpt
