// SPDX-License-Identifier: GPL-2.0-or-later
// GPU time of a frame and of its passes, by timestamps. Each stretch ends where all that came before has finished, so
// the times add up even where passes overlap. Every timestamp costs Mesa's CPU driver 60 us, as it rasterises a scene
// of its own for it: so the passes are timed in one frame of a few, and the other ones have two timestamps.
#pragma once

#include "ref_vkpt/extension.hpp"
#include "ref_vkpt/pass_statistics.hpp"
#include "ref_vkpt/vulkan/handle.hpp"
#include "ref_vkpt/vulkan/swapchain.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace vkpt {

class FrameTimer {
public:
    explicit FrameTimer(const Device& device);
    FrameTimer(const FrameTimer&) = delete;
    FrameTimer& operator=(const FrameTimer&) = delete;

    // Reads what the slot's last use measured (the device has finished it) and starts anew.
    void begin_frame(VkCommandBuffer commands, uint32_t frame_slot);
    // The slot's next commands are no frame: nothing is timed until one begins. The device has finished all of them.
    void begin_untimed(uint32_t frame_slot);
    // Closes the stretch since the previous mark (or begin_frame) under `name`, which lives as long as the module.
    void mark(VkCommandBuffer commands, const char* name);
    // Closes the last stretch, and the frame.
    void end_frame(VkCommandBuffer commands, const char* name);
    // The frame shows a view: the time from the last one's completion to its own counts.
    void note_view() { slots_[slot_].has_view = true; }
    // The frame shows a view in the size that follows the time of a frame (pt_target_ms).
    void note_scaled_view() { slots_[slot_].has_scaled_view = true; }
    // Of such frames that have been read back since the last call, the oldest first.
    std::vector<double> take_scaled_milliseconds() { return std::exchange(scaled_milliseconds_, {}); }
    // Of the newest frame that has been read back; 0: there is none, or the queue has no timestamps.
    double frame_milliseconds() const { return frame_milliseconds_; }
    // Of the newest one whose passes were timed; a name marked several times is one row.
    const std::vector<PassTime>& times() const { return times_; }
    // The passes of every frame are timed from now on.
    void time_every_pass() { times_every_pass_ = true; }
    // Reads the times of all slots now, the oldest first; the device must have finished them. `next_slot` is the one
    // that the next frame will use.
    void read_back_all(uint32_t next_slot)
    {
        for (uint32_t i = 0; i < frames_in_flight; i++)
            read_back((next_slot + i) % frames_in_flight);
    }
    // Every frame that is read back from now on is added to these, too; nullptr: to none. By turns a frame's passes,
    // and the time between completions as `whole_frame`, which timing the passes would lengthen.
    void collect_into(PassStatistics* statistics) { statistics_ = statistics; }
    // The next frame's passes are timed.
    void restart_turns() { frame_number_ = 0; }

private:
    struct Slot {
        QueryPool pool;
        std::vector<const char*> names; // one a stretch
        bool has_view = false, has_scaled_view = false, times_passes = false;
    };
    void read_back(uint32_t frame_slot);
    void add_up_passes(const Slot& slot, const std::vector<uint64_t>& stamps);
    void collect(const Slot& slot, const std::vector<uint64_t>& stamps);
    void stamp(VkCommandBuffer commands, const char* name);
    double milliseconds_between(uint64_t begin, uint64_t end) const;
    bool can_time() const { return device_.timestamp_bits > 0; }

    const Device& device_;
    std::array<Slot, frames_in_flight> slots_;
    uint32_t slot_ = 0, frame_number_ = 0;
    bool times_every_pass_ = false;
    double frame_milliseconds_ = 0;
    std::vector<double> scaled_milliseconds_;
    std::vector<PassTime> times_;
    PassStatistics* statistics_ = nullptr;
    std::optional<uint64_t> last_end_; // of the frame that was read back last, if it showed a view
};

} // namespace vkpt
