// SPDX-License-Identifier: GPL-2.0-or-later
// Handles that a device made, destroyed with their owner: by then the device must no longer use them. Whatever owns
// something of the device (handles, allocations, buffers, images) is empty after a move, and gives back at once what it
// had when another is moved into it.
#pragma once

#include "ref_vkpt/vulkan/device.hpp"

#include <utility>

namespace vkpt {

// handle.renew(create, device, info), whose failure is thrown.
#define VKPT_RENEW(handle, create, device, info) ::vkpt::check_vulkan((handle).renew(create, device, info), #create)

// `destroy`: Vulkan's entry point for it, such as vkDestroyBuffer.
template <class Raw, auto& destroy> class Handle {
public:
    Handle() = default;
    Handle(VkDevice device, Raw raw)
        : device_(device)
        , raw_(raw)
    {
    }
    Handle(Handle&& other) noexcept { swap(other); }
    Handle& operator=(Handle other) noexcept
    {
        swap(other);
        return *this;
    }
    ~Handle()
    {
        if (raw_)
            destroy(device_, raw_, nullptr);
    }

    void swap(Handle& other) noexcept
    {
        std::swap(device_, other.device_);
        std::swap(raw_, other.raw_);
    }

    operator Raw() const { return raw_; }
    // Destroys the one so far, and takes what `create` makes, such as vkCreateBuffer.
    template <class Create, class Info> VkResult renew(Create create, VkDevice device, const Info& info)
    {
        *this = {};
        Raw made = VK_NULL_HANDLE;
        const VkResult result = create(device, &info, nullptr, &made);
        if (result >= 0)
            *this = Handle(device, made);
        return result;
    }

private:
    VkDevice device_ = VK_NULL_HANDLE;
    Raw raw_ = VK_NULL_HANDLE;
};

using CommandPool = Handle<VkCommandPool, vkDestroyCommandPool>;
using DescriptorPool = Handle<VkDescriptorPool, vkDestroyDescriptorPool>;
using DescriptorSetLayout = Handle<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using Fence = Handle<VkFence, vkDestroyFence>;
using Pipeline = Handle<VkPipeline, vkDestroyPipeline>;
using QueryPool = Handle<VkQueryPool, vkDestroyQueryPool>;
using Semaphore = Handle<VkSemaphore, vkDestroySemaphore>;
using ShaderModule = Handle<VkShaderModule, vkDestroyShaderModule>;

} // namespace vkpt
