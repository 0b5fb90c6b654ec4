// SPDX-License-Identifier: GPL-2.0-or-later
// Loads data onto the device outside of frames (registration): records copies into one command buffer, run by flush().
#pragma once

#include "ref_vkpt/vulkan/resources.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

class Uploader {
public:
    explicit Uploader(const Gpu& gpu);
    ~Uploader();
    Uploader(const Uploader&) = delete;
    Uploader& operator=(const Uploader&) = delete;

    // A device buffer with these contents. Usable after flush().
    Buffer make_buffer(std::span<const std::byte> bytes, MemoryKind kind, std::string_view name);
    template <class T> Buffer make_buffer(const std::vector<T>& items, MemoryKind kind, std::string_view name)
    {
        return make_buffer(std::as_bytes(std::span(items)), kind, name);
    }
    // Fills one mip level from tightly packed pixels and leaves it in SHADER_READ_ONLY. The image needs TRANSFER_DST
    // usage. Mip levels come from the CPU: scaling blits are drawn, which Mesa's CPU driver cannot do at the vector
    // width that makes its compute shaders fast (see Device).
    void fill_image(const Image& image, uint32_t mip, std::span<const std::byte> pixels);
    // Submits what was recorded and waits for it. Does nothing if nothing was recorded.
    void flush();

    // For other work that belongs to the load: recorded behind the copies so far, run by flush().
    VkCommandBuffer commands() { return begin(); }

private:
    VkCommandBuffer begin();
    Buffer& stage(std::span<const std::byte> bytes);

    Gpu gpu_;
    CommandPool pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    bool recording_ = false;
    VkDeviceSize staged_bytes_ = 0;
    std::vector<Buffer> staging_;
};

} // namespace vkpt
