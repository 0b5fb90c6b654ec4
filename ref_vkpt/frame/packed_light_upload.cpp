// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/packed_light_upload.hpp"

namespace vkpt {

VkDeviceAddress PackedLightUpload::write(uint32_t frame_slot, std::span<const shared::Emitter> fixed, uint64_t version,
    std::span<const shared::Emitter> moving, size_t moving_count, std::span<const float> scales)
{
    if (version_ != version) {
        writer_ = PackedLightWriter(fixed);
        version_ = version;
    }
    Slot& slot = slots_[frame_slot];
    const size_t bytes = (fixed.size() + moving_count) * sizeof(shared::PackedLight);
    if (make_room(slot.buffer, gpu_, bytes, MemoryKind::lights, "packed lights") || slot.version != version)
        slot.scales.clear();
    slot.version = version;
    auto* const packed_lights = reinterpret_cast<shared::PackedLight*>(slot.buffer.mapped());
    writer_.update(packed_lights, slot.scales, fixed, scales);
    write_packed_lights(packed_lights + fixed.size(), moving_count, moving, scales);
    return slot.buffer.address();
}

} // namespace vkpt
