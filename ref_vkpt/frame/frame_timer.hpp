// SPDX-License-Identifier: GPL-2.0-or-later
// GPU time per pass, by timestamps. The full barriers between passes keep them from overlapping, so the times add up.
#pragma once

#include "ref_vkpt/extension.hpp"
#include "ref_vkpt/frame/pass_statistics.hpp"
#include "ref_vkpt/vulkan/swapchain.hpp"

#include <array>
#include <vector>

namespace vkpt {

class FrameTimer {
public:
    explicit FrameTimer(const Device& device);
    ~FrameTimer();
    FrameTimer(const FrameTimer&) = delete;
    FrameTimer& operator=(const FrameTimer&) = delete;

    // Reads what the slot's last use measured (the device has finished it) and starts anew.
    void begin_frame(VkCommandBuffer commands, uint32_t frame_slot);
    // Closes the stretch since the previous mark (or begin_frame) under `name`, which lives as long as the module.
    void mark(VkCommandBuffer commands, const char* name);
    // Of the newest frame that has been read back; a name marked several times is one row.
    const std::vector<PassTime>& times() const { return times_; }
    // Reads the slot's times now; the device must have finished it.
    void read_back(uint32_t frame_slot);
    // The same for all slots, the oldest first: `next_slot` is the one that the next frame will use.
    void read_back_all(uint32_t next_slot)
    {
        for (uint32_t i = 0; i < frames_in_flight; i++)
            read_back((next_slot + i) % frames_in_flight);
    }
    // Every frame that is read back from now on is added to these, too; nullptr: to none.
    void collect_into(PassStatistics* statistics) { statistics_ = statistics; }

private:
    struct Slot {
        VkQueryPool pool = VK_NULL_HANDLE;
        std::vector<const char*> names;
    };
    const Device& device_;
    std::array<Slot, frames_in_flight> slots_;
    uint32_t slot_ = 0;
    std::vector<PassTime> times_;
    PassStatistics* statistics_ = nullptr;
};

} // namespace vkpt
