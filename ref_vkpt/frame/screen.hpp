// SPDX-License-Identifier: GPL-2.0-or-later
// The pictures of a frame: the one that is shown, and the per-pixel buffers of shaders/shared/screen_buffers.def.
#pragma once

#include "ref_vkpt/vulkan/resources.hpp"
#include "shaders/shared/frame.h"

#include <array>

namespace vkpt {

class Screen {
    enum Row {
#define VKPT_SCREEN_BUFFER(type, name) row_##name,
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
        row_count
    };

public:
    explicit Screen(const Gpu& gpu) : gpu_(gpu) { }

    // The device must be idle if this changes anything. True: the output image is new (layout UNDEFINED).
    bool resize_output(VkExtent2D size);
    // Room for a view of this many pixels; true: contents are lost. The device must be idle if they have to grow.
    bool reserve_pixels(glm::uvec2 size);
    // A new view begins: what was stored as NAME is from now on read as previous_NAME.
    void exchange_history();
    bool must_grow(glm::uvec2 size) const;

    // The per-pixel buffers of a view that is not being drawn; at first there are none.
    struct ViewBuffers {
        size_t pixels = 0;
        uint32_t groups = 0;
        std::array<Buffer, row_count> buffers;
        Buffer trace_stack;
        shared::ScreenBuffers addresses {};
    };
    void exchange(ViewBuffers& other);

    const Image& output() const { return output_; }
    const shared::ScreenBuffers& addresses() const { return addresses_; }
    VkDeviceAddress trace_stack() const { return trace_stack_.address(); }
    const Buffer& accumulated() const;
    const Buffer& radiance() const;

private:
    Gpu gpu_;
    Image output_;
    size_t pixels_ = 0;   // that every buffer has room for
    uint32_t groups_ = 0; // that the trace stack has room for
    std::array<Buffer, row_count> buffers_;
    Buffer trace_stack_;
    shared::ScreenBuffers addresses_ {};
};

// Workgroups of a pass over a view of this size; see VKPT_RUN_OVER_PIXELS.
uint32_t pixel_groups(glm::uvec2 size);

} // namespace vkpt
