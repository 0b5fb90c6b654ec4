// SPDX-License-Identifier: GPL-2.0-or-later
// The packed lights of all emitters on the device.
#pragma once

#include "ref_vkpt/frame/uploads.hpp"
#include "ref_vkpt/lights/packed_lights.hpp"

#include <cstdint>

namespace vkpt {

// Kept by each frame in flight.
class PackedLightUpload {
public:
    explicit PackedLightUpload(const Gpu& gpu)
        : gpu_(gpu)
    {
    }

    // Once a frame; the device has finished with this slot. `version`: another number whenever `fixed` changes.
    VkDeviceAddress write(uint32_t frame_slot, std::span<const shared::Emitter> fixed, uint64_t version,
        std::span<const shared::Emitter> moving, size_t moving_count, std::span<const float> scales);
    const Buffer& buffer(uint32_t frame_slot) const { return slots_[frame_slot].buffer; }

private:
    struct Slot {
        Buffer buffer;
        uint64_t version = 0;
        std::vector<float> scales;
    };
    Gpu gpu_;
    uint64_t version_ = 0;
    PackedLightWriter writer_; // for version_
    std::array<Slot, frames_in_flight> slots_;
};

} // namespace vkpt
