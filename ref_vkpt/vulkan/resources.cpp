// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/resources.hpp"

#include <algorithm>
#include <vector>

namespace vkpt {

namespace {

constexpr VkDeviceSize min_buffer_bytes = 16;

MemoryWish memory_wish(const Device& device, BufferHome home)
{
    constexpr VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                    mappable
        = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    switch (home) {
    case BufferHome::device: // what can be mapped is left to what has to be, where it is little
        return { local, 0, device.maps_all_memory ? 0 : VkMemoryPropertyFlags(VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) };
    case BufferHome::upload:
        return { mappable, local, 0 };
    case BufferHome::staging:
        return { mappable, 0, local };
    case BufferHome::readback:
        return { mappable, VK_MEMORY_PROPERTY_HOST_CACHED_BIT, local };
    }
    return {};
}

VkFormat texel_format(uint32_t words)
{
    return words == 1 ? VK_FORMAT_R32_UINT : words == 2 ? VK_FORMAT_R32G32_UINT : VK_FORMAT_R32G32B32A32_UINT;
}

} // namespace

Buffer::Buffer(const Gpu& gpu, VkDeviceSize bytes, BufferHome home, MemoryKind kind, std::string_view name)
    : size_(std::max<VkDeviceSize>(bytes, min_buffer_bytes))
{
    const VkDevice device = gpu.device.handle;
    VkBufferCreateInfo info { VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO };
    info.size = size_;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT
        | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT
        | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    if (gpu.device.has_acceleration_structures())
        info.usage |= VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR
            | VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
    if (gpu.device.has_ray_pipeline)
        info.usage |= VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR;
    const std::vector<uint32_t> families = gpu.device.queue_families();
    if (families.size() > 1)
        info.sharingMode = VK_SHARING_MODE_CONCURRENT;
    info.queueFamilyIndexCount = uint32_t(families.size());
    info.pQueueFamilyIndices = families.data();
    VKPT_RENEW(handle_, vkCreateBuffer, device, info);
    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(device, handle_, &requirements);
    allocation_ = gpu.memory.allocate(requirements, memory_wish(gpu.device, home), true, kind);
    VKPT_CHECK(vkBindBufferMemory(device, handle_, allocation_.memory(), allocation_.offset()));
    VkBufferDeviceAddressInfo address { VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO };
    address.buffer = handle_;
    address_ = vkGetBufferDeviceAddress(device, &address);
    gpu.device.name_object(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(handle()), name);
}

TexelView::TexelView(const Gpu& gpu, const Buffer& buffer, uint32_t words)
{
    const VkDeviceSize texel_bytes = words * sizeof(uint32_t);
    VkBufferViewCreateInfo info { VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO };
    info.buffer = buffer.handle();
    info.format = texel_format(words);
    info.range = buffer.size() / texel_bytes * texel_bytes;
    VKPT_RENEW(handle_, vkCreateBufferView, gpu.device.handle, info);
}

Image::Image(const Gpu& gpu, const ImageSettings& settings, std::string_view name)
    : settings_(settings)
{
    const VkDevice device = gpu.device.handle;
    const VkFormat view_format = settings.view_format == VK_FORMAT_UNDEFINED ? settings.format : settings.view_format;
    VkImageCreateInfo info { VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO };
    if (view_format != settings.format)
        info.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = settings.format;
    info.extent = { settings.width, settings.height, 1 };
    info.mipLevels = settings.mip_levels;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = settings.usage;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    VKPT_RENEW(handle_, vkCreateImage, device, info);
    VkMemoryRequirements requirements;
    vkGetImageMemoryRequirements(device, handle_, &requirements);
    allocation_ = gpu.memory.allocate(requirements, memory_wish(gpu.device, BufferHome::device), false, settings.kind);
    VKPT_CHECK(vkBindImageMemory(device, handle_, allocation_.memory(), allocation_.offset()));
    VkImageViewCreateInfo view { VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO };
    view.image = handle_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = view_format;
    view.subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, settings.mip_levels, 0, 1 };
    VKPT_RENEW(view_, vkCreateImageView, device, view);
    gpu.device.name_object(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(handle()), name);
}

void record_barrier(VkCommandBuffer commands, const ImageBarrier& b)
{
    VkImageMemoryBarrier barrier { VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER };
    barrier.srcAccessMask = b.from_access;
    barrier.dstAccessMask = b.to_access;
    barrier.oldLayout = b.from;
    barrier.newLayout = b.to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = b.image;
    barrier.subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, b.first_mip, b.mip_count, 0, 1 };
    vkCmdPipelineBarrier(commands, b.from_stage, b.to_stage, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

void record_memory_barrier(VkCommandBuffer commands, VkPipelineStageFlags from_stage, VkAccessFlags from_access,
    VkPipelineStageFlags to_stage, VkAccessFlags to_access)
{
    VkMemoryBarrier barrier { VK_STRUCTURE_TYPE_MEMORY_BARRIER };
    barrier.srcAccessMask = from_access;
    barrier.dstAccessMask = to_access;
    vkCmdPipelineBarrier(commands, from_stage, to_stage, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

} // namespace vkpt
