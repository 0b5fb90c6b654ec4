// SPDX-License-Identifier: GPL-2.0-or-later
// Marks that the device leaves as it begins each pass of a frame, where the CPU can read them after the device was
// lost: the last one names the pass that did not end. One word a pass and frame in flight, by which a frame costs a few
// microseconds; CPU drivers, whose losses have a stack, leave none.
#pragma once

#include "ref_vkpt/vulkan/resources.hpp"
#include "ref_vkpt/vulkan/swapchain.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vkpt {

class PassMarkers {
public:
    explicit PassMarkers(const Gpu& gpu);

    // The device has finished the slot's last frame, and a barrier before these commands orders it with transfers.
    void begin_frame(uint32_t frame_slot, uint64_t frame_number);
    // Before the pass's dispatch. `name` lives as long as the module. Outside of frames nothing is marked.
    void begin_pass(VkCommandBuffer commands, const char* name);
    void end_frame() { recording_ = false; }
    // "in the pass NAME", of the newest frame that the device began; also after it was lost.
    std::string describe_last() const;

private:
    struct Slot {
        std::vector<const char*> names; // of the passes recorded
        uint32_t mark = 0; // what the device writes in this frame; 0: none
    };
    uint32_t marks_found(uint32_t frame_slot) const;

    Buffer marks_; // empty: none are left
    std::array<Slot, frames_in_flight> slots_;
    uint32_t slot_ = 0;
    bool recording_ = false;
};

} // namespace vkpt
