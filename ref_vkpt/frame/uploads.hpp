// SPDX-License-Identifier: GPL-2.0-or-later
// Data that the CPU writes every frame and shaders read by address. Each frame in flight has memory of its own.
#pragma once

#include "ref_vkpt/vulkan/resources.hpp"
#include "ref_vkpt/vulkan/swapchain.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

// Memory to fill before the device runs.
struct Upload {
    std::byte* mapped = nullptr;
    VkDeviceAddress address = 0;
    template <class T> T* as() const { return reinterpret_cast<T*>(mapped); }
};

// A bump allocator; grows by another buffer, which is folded into one when the frame's turn comes again.
class FrameUploads {
public:
    FrameUploads(const Gpu& gpu, MemoryKind kind)
        : gpu_(gpu)
        , kind_(kind)
    {
    }

    // The device has finished the last frame with this slot.
    void begin_frame(uint32_t frame_slot);
    // Valid until the frame is submitted.
    Upload reserve(size_t bytes);
    VkDeviceAddress push(std::span<const std::byte> bytes);
    template <class T> VkDeviceAddress push(const std::vector<T>& items)
    {
        return push(std::as_bytes(std::span(items)));
    }

private:
    struct Slot {
        std::vector<Buffer> buffers; // the last one is being filled
        VkDeviceSize used = 0; // of the last
        VkDeviceSize total = 0; // of all, for folding
    };
    Gpu gpu_;
    MemoryKind kind_;
    std::array<Slot, frames_in_flight> slots_;
    uint32_t slot_ = 0;
};

// Room for `bytes`, and for some more to come. True: it is new memory, and empty.
bool make_room(Buffer& buffer, const Gpu& gpu, VkDeviceSize bytes, MemoryKind kind, const char* name,
    BufferHome home = BufferHome::upload);

// An array whose front part changes only with the map and whose rest changes every frame: the front is copied once per
// frame in flight. Where the CPU sees little of the device's memory (Device::maps_all_memory), the array lies out of
// its sight, and both parts are copied there.
class PrefixedUpload {
public:
    PrefixedUpload(const Gpu& gpu, MemoryKind kind, const char* name)
        : gpu_(gpu)
        , kind_(kind)
        , name_(name)
    {
    }

    // `prefix_version`: another number whenever the prefix changes. The device has finished with this slot.
    // The result's address is the prefix's, its memory is for the rest, which is to be written, not read.
    Upload reserve(uint32_t frame_slot, std::span<const std::byte> prefix, uint64_t prefix_version, size_t rest_bytes);
    template <class T>
    Upload reserve(uint32_t frame_slot, const std::vector<T>& prefix, uint64_t prefix_version, size_t rest_count)
    {
        return reserve(frame_slot, std::as_bytes(std::span(prefix)), prefix_version, rest_count * sizeof(T));
    }
    // Records the copies of what was reserved since the last call, if any are needed. They need a barrier behind them.
    void record_copies(VkCommandBuffer commands, uint32_t frame_slot);
    const Buffer& buffer(uint32_t frame_slot) const { return slots_[frame_slot].buffer; }

private:
    struct Slot {
        Buffer buffer;
        uint64_t version = 0;
        Buffer prefix_staging, rest_staging; // where it is copied; the first while its copy may be under way
        VkDeviceSize prefix_bytes = 0, rest_bytes = 0; // of the copies to be recorded
        VkDeviceSize rest_start = 0; // in the buffer
    };
    Upload reserve_staged(
        Slot& slot, std::span<const std::byte> prefix, uint64_t prefix_version, VkDeviceSize rest_bytes);
    Gpu gpu_;
    MemoryKind kind_;
    const char* name_;
    std::array<Slot, frames_in_flight> slots_;
};

// An array of which little changes from frame to frame: each frame in flight keeps it, and only what differs is
// written.
class KeptUpload {
public:
    KeptUpload(const Gpu& gpu, MemoryKind kind, const char* name)
        : gpu_(gpu)
        , kind_(kind)
        , name_(name)
    {
    }

    // Once a frame; the device has finished with this slot.
    VkDeviceAddress write(uint32_t frame_slot, std::span<const std::byte> bytes);
    template <class T> VkDeviceAddress write(uint32_t frame_slot, const std::vector<T>& items)
    {
        return write(frame_slot, std::as_bytes(std::span(items)));
    }

    const Buffer& buffer(uint32_t frame_slot) const { return slots_[frame_slot].buffer; }

private:
    struct Slot {
        Buffer buffer;
        std::vector<std::byte> held;
    };
    Gpu gpu_;
    MemoryKind kind_;
    const char* name_;
    std::array<Slot, frames_in_flight> slots_;
};

} // namespace vkpt
