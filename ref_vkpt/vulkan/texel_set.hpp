// SPDX-License-Identifier: GPL-2.0-or-later
// A descriptor set of buffers that shaders read as texels (shaders/lib/device/texels.glsl): as many bindings, or one
// array. Destroying it demands that the device no longer uses it.
#pragma once

#include "ref_vkpt/vulkan/resources.hpp"

#include <cstdint>
#include <vector>

namespace vkpt {

enum class TexelShape { bindings, array };

class TexelSet {
public:
    TexelSet() = default;
    // At first each buffer is an empty one.
    TexelSet(const Gpu& gpu, VkDescriptorSetLayout layout, TexelShape shape, uint32_t count);

    // The device must not use the set, and the buffer must outlive what is bound. `words`: 32-bit words of a texel, 1,
    // 2 or 4. nullptr: an empty buffer.
    void bind(const Gpu& gpu, uint32_t number, const Buffer* buffer, uint32_t words);

    VkDescriptorSet handle() const { return set_; }
    explicit operator bool() const { return set_ != VK_NULL_HANDLE; }

private:
    TexelShape shape_ = TexelShape::bindings;
    Buffer empty_;
    std::vector<TexelView> views_;
    DescriptorPool pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

} // namespace vkpt
