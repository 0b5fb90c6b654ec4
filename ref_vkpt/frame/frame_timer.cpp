// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/frame_timer.hpp"

#include "ref_vkpt/frame/bench_report.hpp"
#include "ref_vkpt/vulkan/commands.hpp"

#include <algorithm>
#include <string_view>

namespace vkpt {

namespace {

constexpr uint32_t max_timestamps = 128; // beyond it a frame's further passes (many small views) are not timed
constexpr uint32_t frames_a_glance = 16; // one of so many has its passes timed while nobody collects the times

} // namespace

FrameTimer::FrameTimer(const Device& device)
    : device_(device)
{
    for (Slot& slot : slots_)
        if (can_time())
            slot.pool = make_timestamp_pool(device, max_timestamps);
}

double FrameTimer::milliseconds_between(uint64_t begin, uint64_t end) const
{
    return device_.nanoseconds_between(begin, end) * 1e-6;
}

void FrameTimer::read_back(uint32_t frame_slot)
{
    Slot& slot = slots_[frame_slot];
    if (slot.names.empty())
        return;
    std::vector<uint64_t> stamps(slot.names.size() + 1);
    const VkResult result = vkGetQueryPoolResults(device_.handle, slot.pool, 0, uint32_t(stamps.size()),
        stamps.size() * sizeof(uint64_t), stamps.data(), sizeof(uint64_t), VK_QUERY_RESULT_64_BIT);
    if (result == VK_SUCCESS) {
        frame_milliseconds_ = milliseconds_between(stamps.front(), stamps.back());
        if (slot.has_scaled_view)
            scaled_milliseconds_.push_back(frame_milliseconds_);
        if (slot.times_passes)
            add_up_passes(slot, stamps);
        collect(slot, stamps);
    }
    slot.names.clear();
}

void FrameTimer::add_up_passes(const Slot& slot, const std::vector<uint64_t>& stamps)
{
    times_.clear();
    for (size_t i = 0; i < slot.names.size(); i++) {
        const std::string_view name = slot.names[i];
        const double milliseconds = milliseconds_between(stamps[i], stamps[i + 1]);
        const auto row = std::ranges::find_if(times_, [&](const PassTime& time) { return name == time.name; });
        if (row != times_.end())
            row->milliseconds += milliseconds;
        else
            times_.push_back({ slot.names[i], milliseconds });
    }
}

// With frames in flight the host returns from every other frame at once: only completions are evenly spaced. Before the
// first view, and after a frame of 2D alone (loading), there is nothing to count from but the frame's own begin.
void FrameTimer::collect(const Slot& slot, const std::vector<uint64_t>& stamps)
{
    if (statistics_ && slot.times_passes)
        for (const PassTime& time : times_)
            statistics_->add(time.name, time.milliseconds);
    else if (statistics_ && slot.has_view)
        statistics_->add(whole_frame, milliseconds_between(last_end_.value_or(stamps.front()), stamps.back()));
    last_end_ = slot.has_view ? std::optional(stamps.back()) : std::nullopt;
}

void FrameTimer::begin_frame(VkCommandBuffer commands, uint32_t frame_slot)
{
    read_back(frame_slot);
    slot_ = frame_slot;
    slots_[slot_].has_view = slots_[slot_].has_scaled_view = false;
    const uint32_t turn = statistics_ ? 2 : frames_a_glance;
    slots_[slot_].times_passes = times_every_pass_ || frame_number_++ % turn == 0;
    if (!can_time())
        return;
    vkCmdResetQueryPool(commands, slots_[slot_].pool, 0, max_timestamps);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, slots_[slot_].pool, 0);
}

void FrameTimer::begin_untimed(uint32_t frame_slot)
{
    read_back_all(frame_slot);
    slot_ = frame_slot;
    slots_[slot_].times_passes = false;
    last_end_.reset();
}

void FrameTimer::mark(VkCommandBuffer commands, const char* name)
{
    // The last query is the frame's end.
    if (slots_[slot_].times_passes && slots_[slot_].names.size() + 2 < max_timestamps)
        stamp(commands, name);
}

void FrameTimer::end_frame(VkCommandBuffer commands, const char* name) { stamp(commands, name); }

void FrameTimer::stamp(VkCommandBuffer commands, const char* name)
{
    if (!can_time())
        return;
    Slot& slot = slots_[slot_];
    slot.names.push_back(name);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, slot.pool, uint32_t(slot.names.size()));
}

} // namespace vkpt
