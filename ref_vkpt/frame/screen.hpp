// SPDX-License-Identifier: GPL-2.0-or-later
// The pictures of a frame: the one that is shown, and the per-pixel buffers of shaders/shared/screen_buffers.def.
#pragma once

#include "ref_vkpt/vulkan/bindings.hpp"
#include "ref_vkpt/vulkan/resources.hpp"
#include "ref_vkpt/vulkan/texel_set.hpp"
#include "shaders/shared/frame.h"

#include <array>
#include <utility>

namespace vkpt {

// The picture that is shown: a word for each pixel, RGBA with red in the lowest byte, sRGB-encoded. A buffer rather
// than an image, whose texels Mesa's CPU driver stores one after the other.
struct OutputPicture {
    Buffer words;
    VkExtent2D size {};

    explicit operator bool() const { return bool(words); }
};

class Screen {
    enum Row {
#define VKPT_SCREEN_BUFFER(type, name) row_##name,
#include "shaders/shared/screen_buffers.def"
#undef VKPT_SCREEN_BUFFER
    };

public:
    Screen(const Gpu& gpu, const Bindings& bindings)
        : gpu_(gpu)
        , bindings_(bindings)
    {
    }

    // The device must be idle.
    void resize_output(VkExtent2D size);
    // Room for a view of this many pixels; true: contents are lost. The device must be idle if they have to grow.
    bool reserve_pixels(glm::uvec2 size);
    // A new view begins: what was stored as NAME is from now on read as previous_NAME.
    void exchange_history();
    bool must_grow(glm::uvec2 size) const;

    // The per-pixel buffers of one view; at first there are none.
    struct ViewBuffers {
        size_t pixels = 0; // that every buffer has room for
        uint32_t groups = 0; // that the trace stack has room for
        std::array<Buffer, shared::SCREEN_BUFFER_COUNT> buffers;
        // Descriptor set 3, for the drivers that read tables so (Device::reads_texels). Others find empty buffers here.
        TexelSet texels;
        Buffer trace_stack;
        shared::ScreenBuffers rows {};
    };
    // Takes up another view's and leaves there those of the view drawn so far.
    void exchange(ViewBuffers& other) { std::swap(view_, other); }

    const OutputPicture& output() const { return output_; }
    const shared::ScreenBuffers& rows() const { return view_.rows; }
    VkDescriptorSet texels() const { return view_.texels.handle(); }
    VkDeviceAddress trace_stack() const { return view_.trace_stack.address(); }
    const Buffer& accumulated() const { return view_.buffers[row_accumulated]; }
    const Buffer& radiance() const { return view_.buffers[row_radiance]; }

private:
    Gpu gpu_;
    const Bindings& bindings_;
    OutputPicture output_;
    ViewBuffers view_;
};

TexelSet make_screen_texels(const Gpu& gpu, const Bindings& bindings);

// Of blocks that cover a view of this size.
glm::uvec2 count_blocks(glm::uvec2 size, glm::uvec2 block);

// Workgroups of a pass over a view of this size; see VKPT_RUN_OVER_PIXELS.
uint32_t pixel_groups(glm::uvec2 size);

} // namespace vkpt
