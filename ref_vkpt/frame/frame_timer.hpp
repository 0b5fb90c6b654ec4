// SPDX-License-Identifier: GPL-2.0-or-later
// GPU time per pass, by timestamps. The full barriers between passes keep them from overlapping, so the times add up.
#pragma once

#include "ref_vkpt/extension.hpp"
#include "ref_vkpt/frame/pass_statistics.hpp"
#include "ref_vkpt/vulkan/swapchain.hpp"

#include <array>
#include <optional>
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
    // The frame shows a view: the time from the last one's completion to its own counts.
    void note_view() { slots_[slot_].has_view = true; }
    // Of the newest frame that has been read back; a name marked several times is one row.
    const std::vector<PassTime>& times() const { return times_; }
    // Reads the times of all slots now, the oldest first; the device must have finished them. `next_slot` is the one that
    // the next frame will use.
    void read_back_all(uint32_t next_slot)
    {
        for (uint32_t i = 0; i < frames_in_flight; i++)
            read_back((next_slot + i) % frames_in_flight);
    }
    // Every frame that is read back from now on is added to these, too, its passes and the time between completions as
    // `whole_frame`; nullptr: to none.
    void collect_into(PassStatistics* statistics) { statistics_ = statistics; }

private:
    struct Slot {
        VkQueryPool pool = VK_NULL_HANDLE;
        std::vector<const char*> names;
        bool has_view = false;
    };
    void read_back(uint32_t frame_slot);
    void collect(const Slot& slot, const std::vector<uint64_t>& stamps);
    double to_milliseconds(uint64_t ticks) const;

    const Device& device_;
    std::array<Slot, frames_in_flight> slots_;
    uint32_t slot_ = 0;
    std::vector<PassTime> times_;
    PassStatistics* statistics_ = nullptr;
    std::optional<uint64_t> last_end_; // of the frame that was read back last, if it showed a view
};

} // namespace vkpt
