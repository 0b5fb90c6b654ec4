// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/uploader.hpp"

#include "ref_vkpt/vulkan/commands.hpp"

#include <algorithm>
#include <cstring>

namespace vkpt {

namespace {

// So much staging memory makes a flush of its own, lest a mod's textures fill the memory twice.
constexpr VkDeviceSize staging_limit = 64u << 20;

} // namespace

Uploader::Uploader(const Gpu& gpu)
    : gpu_(gpu)
    , pool_(make_command_pool(gpu.device, gpu.device.queue_family))
    , commands_(make_command_buffer(gpu.device, pool_))
{
    // A level that is dropped for want of memory takes along what the copies recorded so far fill.
    gpu.memory.set_relief([this] { flush(); });
}

Uploader::~Uploader()
{
    gpu_.memory.set_relief(nullptr);
    vkDeviceWaitIdle(gpu_.device.handle);
}

VkCommandBuffer Uploader::begin()
{
    if (!recording_) {
        begin_commands(commands_);
        recording_ = true;
    }
    return commands_;
}

Buffer& Uploader::stage(std::span<const std::byte> bytes)
{
    if (staged_bytes_ + bytes.size() > staging_limit)
        flush();
    Buffer staging(gpu_, bytes.size(), BufferHome::staging, MemoryKind::staging, "staging"); // may flush
    if (!bytes.empty())
        std::memcpy(staging.mapped(), bytes.data(), bytes.size());
    staged_bytes_ += bytes.size();
    return staging_.emplace_back(std::move(staging));
}

Buffer Uploader::make_buffer(std::span<const std::byte> bytes, MemoryKind kind, std::string_view name)
{
    Buffer buffer(gpu_, bytes.size(), BufferHome::device, kind, name);
    if (bytes.empty())
        return buffer;
    const Buffer& staging = stage(bytes);
    const VkBufferCopy region { 0, 0, bytes.size() };
    vkCmdCopyBuffer(begin(), staging.handle(), buffer.handle(), 1, &region);
    return buffer;
}

void Uploader::fill_image(const Image& image, uint32_t mip, std::span<const std::byte> pixels)
{
    const Buffer& staging = stage(pixels);
    const VkCommandBuffer commands = begin();
    constexpr VkPipelineStageFlags transfer = VK_PIPELINE_STAGE_TRANSFER_BIT;
    record_barrier(commands,
        { image.handle(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, transfer, transfer, 0,
            VK_ACCESS_TRANSFER_WRITE_BIT, mip, 1 });
    VkBufferImageCopy region {};
    region.imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1 };
    region.imageExtent = { std::max(image.width() >> mip, 1u), std::max(image.height() >> mip, 1u), 1 };
    vkCmdCopyBufferToImage(
        commands, staging.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    record_barrier(commands,
        { image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, transfer,
            VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_SHADER_READ_BIT, mip, 1 });
}

void Uploader::flush()
{
    if (!recording_)
        return;
    // Whether it succeeds or not: nothing that was recorded is kept.
    struct Ending {
        Uploader& uploader;
        ~Ending()
        {
            vkResetCommandPool(uploader.gpu_.device.handle, uploader.pool_, 0);
            uploader.recording_ = false;
            uploader.staging_.clear();
            uploader.staged_bytes_ = 0;
        }
    } const ending { *this };
    record_memory_barrier(commands_, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
        VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_READ_BIT);
    submit_commands(gpu_.device.queue, commands_);
    VKPT_CHECK(vkQueueWaitIdle(gpu_.device.queue));
}

} // namespace vkpt
