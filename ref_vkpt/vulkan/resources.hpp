// SPDX-License-Identifier: GPL-2.0-or-later
// Buffers and images that own their handle and memory. Destroying one demands that the device no longer uses it.
#pragma once

#include "ref_vkpt/vulkan/handle.hpp"
#include "ref_vkpt/vulkan/memory.hpp"

#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

namespace vkpt {

// Device and memory, handed to whatever makes resources.
struct Gpu {
    const Device& device;
    MemoryAllocator& memory;
};

enum class BufferHome {
    device, // filled by copies or shaders
    upload, // written by the CPU, read by shaders: on the device where it can be mapped there
    staging, // written by the CPU, copied: not on the device, whose memory that can be mapped may be little
    readback, // written by the device, read by the CPU
};

class Buffer {
public:
    Buffer() = default;
    // At least 16 bytes are made, so that an empty list has an address and a texel, too.
    Buffer(const Gpu& gpu, VkDeviceSize bytes, BufferHome home, MemoryKind kind, std::string_view name);
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer other) noexcept
    {
        swap(other);
        return *this;
    }
    void swap(Buffer& other) noexcept
    {
        std::swap(size_, other.size_);
        std::swap(address_, other.address_);
        allocation_.swap(other.allocation_);
        handle_.swap(other.handle_);
    }

    VkBuffer handle() const { return handle_; }
    VkDeviceSize size() const { return size_; }
    VkDeviceAddress address() const { return address_; }
    std::byte* mapped() const { return static_cast<std::byte*>(allocation_.mapped()); }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

private:
    VkDeviceSize size_ = 0;
    VkDeviceAddress address_ = 0;
    Allocation allocation_;
    Handle<VkBuffer, vkDestroyBuffer> handle_;
};

// A buffer as texels of 1, 2 or 4 words of 32 bits, which shaders read as numbers without sign. The buffer must outlive
// it.
class TexelView {
public:
    TexelView() = default;
    TexelView(const Gpu& gpu, const Buffer& buffer, uint32_t words);

    VkBufferView handle() const { return handle_; }

private:
    Handle<VkBufferView, vkDestroyBufferView> handle_;
};

struct ImageSettings {
    uint32_t width = 1, height = 1;
    uint32_t mip_levels = 1;
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    VkFormat view_format = VK_FORMAT_UNDEFINED; // undefined: `format`
    MemoryKind kind = MemoryKind::textures;
};

class Image {
public:
    Image() = default;
    Image(const Gpu& gpu, const ImageSettings& settings, std::string_view name);
    Image(Image&& other) noexcept { swap(other); }
    Image& operator=(Image other) noexcept
    {
        swap(other);
        return *this;
    }
    void swap(Image& other) noexcept
    {
        std::swap(settings_, other.settings_);
        allocation_.swap(other.allocation_);
        handle_.swap(other.handle_);
        view_.swap(other.view_);
    }

    VkImage handle() const { return handle_; }
    VkImageView view() const { return view_; }
    uint32_t width() const { return settings_.width; }
    uint32_t height() const { return settings_.height; }
    uint32_t mip_levels() const { return settings_.mip_levels; }
    VkFormat format() const { return settings_.format; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

private:
    ImageSettings settings_;
    Allocation allocation_;
    Handle<VkImage, vkDestroyImage> handle_;
    Handle<VkImageView, vkDestroyImageView> view_;
};

// Whole-image layout change with the given scopes.
struct ImageBarrier {
    VkImage image;
    VkImageLayout from, to;
    VkPipelineStageFlags from_stage, to_stage;
    VkAccessFlags from_access, to_access;
    uint32_t first_mip = 0;
    uint32_t mip_count = VK_REMAINING_MIP_LEVELS;
};
void record_barrier(VkCommandBuffer commands, const ImageBarrier& barrier);
void record_memory_barrier(VkCommandBuffer commands, VkPipelineStageFlags from_stage, VkAccessFlags from_access,
    VkPipelineStageFlags to_stage, VkAccessFlags to_access);

} // namespace vkpt
