// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/pass_markers.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace vkpt {

namespace {

constexpr uint32_t max_marks = 256; // further passes (many small views) are not marked

VkDeviceSize place_of(uint32_t frame_slot, uint32_t pass)
{
    return (VkDeviceSize(frame_slot) * max_marks + pass) * sizeof(uint32_t);
}

} // namespace

PassMarkers::PassMarkers(const Gpu& gpu)
{
    if (!gpu.device.traits.can_be_lost)
        return;
    marks_ = Buffer(gpu, place_of(frames_in_flight, 0), BufferHome::readback, MemoryKind::staging, "pass marks");
    std::memset(marks_.mapped(), 0, marks_.size());
}

void PassMarkers::begin_frame(uint32_t frame_slot, uint64_t frame_number)
{
    slot_ = frame_slot;
    slots_[slot_].names.clear();
    slots_[slot_].mark = uint32_t(frame_number) + 1;
    recording_ = true;
}

void PassMarkers::begin_pass(VkCommandBuffer commands, const char* name)
{
    Slot& slot = slots_[slot_];
    if (!recording_ || slot.names.size() == max_marks)
        return;
    if (marks_)
        vkCmdUpdateBuffer(
            commands, marks_.handle(), place_of(slot_, uint32_t(slot.names.size())), sizeof slot.mark, &slot.mark);
    slot.names.push_back(name);
}

uint32_t PassMarkers::marks_found(uint32_t frame_slot) const
{
    const Slot& slot = slots_[frame_slot];
    uint32_t found = 0;
    for (; found < slot.names.size(); found++) {
        uint32_t mark = 0;
        std::memcpy(&mark, marks_.mapped() + place_of(frame_slot, found), sizeof mark);
        if (mark != slot.mark)
            break;
    }
    return found;
}

std::string PassMarkers::describe_last() const
{
    uint32_t newest = 0;
    std::string text;
    for (uint32_t i = 0; i < frames_in_flight; i++) {
        const Slot& slot = slots_[i];
        const uint32_t begun = marks_ ? marks_found(i) : uint32_t(slot.names.size());
        if (begun == 0 || slot.mark <= newest)
            continue;
        newest = slot.mark;
        text = fmt::format("{} {} of frame {}", marks_ ? "in the pass" : "the last pass recorded was",
            slot.names[begun - 1], slot.mark);
    }
    return text.empty() ? "before the first pass" : text;
}

} // namespace vkpt
