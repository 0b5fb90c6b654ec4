// SPDX-License-Identifier: GPL-2.0-or-later
// The per-pixel buffers of a view: shaders/shared/screen_buffers.def.
#pragma once

#include "ref_vkpt/vulkan/bindings.hpp"
#include "ref_vkpt/vulkan/resources.hpp"
#include "ref_vkpt/vulkan/texel_set.hpp"
#include "shaders/shared/frame.h"

#include <array>
#include <cstdint>

namespace vkpt {

// At first there are none.
class ViewBuffers {
    enum Row {
#define VKPT_SCREEN_BUFFER(type, name) row_##name,
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
    };

public:
    // What not every view needs.
    struct Extras {
        bool trace_stacks; // the software backend's, where lanes have none of their own (DeviceTraits::gpu_lanes)
        bool ray_counts; // DEBUG_VIEW_RAYS
    };
    // Room for a view of this many pixels; contents are lost if it has to grow. The device must be idle then.
    void reserve_pixels(const Gpu& gpu, const Bindings& bindings, glm::uvec2 size, Extras extras);
    bool must_grow(glm::uvec2 size, Extras extras) const;
    // A new frame of the view begins: what was stored as NAME is from now on read as previous_NAME. What was stored in
    // borrowed memory has other names.
    void exchange_history();

    const shared::ScreenBuffers& rows() const { return rows_; }
    VkDescriptorSet texels() const { return texels_.handle(); }
    VkDeviceAddress trace_stack() const { return trace_stack_.address(); }
    // Where one of the rows lies.
    const Buffer& buffer_of(const shared::ScreenBuffer& row) const { return buffers_[row.texels]; }

private:
    void lend(); // the rows that lie in others' memory

    // What there is room for; 0 trace groups: there are no stacks, or 0 counted pixels: rays are not counted.
    struct Room {
        uint32_t pixels = 0, strata = 0, trace_groups = 0, counted_pixels = 0;
        bool operator==(const Room&) const = default;
    };
    static Room room_of(glm::uvec2 size, Extras extras);
    Room with(const Room& wanted) const; // the greater of both

    Room room_;
    std::array<Buffer, shared::SCREEN_BUFFER_COUNT> buffers_;
    // Descriptor set 3, for the drivers that read tables so (Device::reads_texels). Others find empty buffers here.
    TexelSet texels_;
    Buffer trace_stack_;
    shared::ScreenBuffers rows_ {};
};

TexelSet make_screen_texels(const Gpu& gpu, const Bindings& bindings);

// Of blocks that cover a view of this size.
glm::uvec2 count_blocks(glm::uvec2 size, glm::uvec2 block);

// Workgroups of a pass over a view of this size; see VKPT_RUN_OVER_PIXELS.
glm::uvec2 pixel_groups(const Device& device, glm::uvec2 size);

} // namespace vkpt
