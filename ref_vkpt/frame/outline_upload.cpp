// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/outline_upload.hpp"

namespace vkpt {

VkDeviceAddress OutlineUpload::write(uint32_t frame_slot, std::span<const shared::Emitter> fixed, uint64_t version,
    std::span<const shared::Emitter> moving, size_t moving_count, std::span<const float> scales)
{
    if (version_ != version) {
        writer_ = OutlineWriter(fixed);
        version_ = version;
    }
    Slot& slot = slots_[frame_slot];
    const size_t bytes = (fixed.size() + moving_count) * sizeof(shared::EmitterOutline);
    if (make_room(slot.buffer, gpu_, bytes, MemoryKind::lights, "emitter outlines") || slot.version != version)
        slot.scales.clear();
    slot.version = version;
    auto* const outlines = reinterpret_cast<shared::EmitterOutline*>(slot.buffer.mapped());
    writer_.update(outlines, slot.scales, fixed, scales);
    write_outlines(outlines + fixed.size(), moving_count, moving, scales);
    return slot.buffer.address();
}

} // namespace vkpt
