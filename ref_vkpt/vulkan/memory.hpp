// SPDX-License-Identifier: GPL-2.0-or-later
// Device memory in large blocks, cut up first-fit: drivers allow only a few thousand allocations, a mod has more
// images.
#pragma once

#include "ref_vkpt/vulkan/device.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <optional>

namespace vkpt {

// What memory is used for; `pt_info` lists the sums.
enum class MemoryKind { textures, geometry, acceleration, lights, images, staging, count };

class MemoryAllocator;

// A piece of a block; gives itself back.
class Allocation {
public:
    Allocation() = default;
    Allocation(Allocation&& other) noexcept { swap(other); }
    Allocation& operator=(Allocation other) noexcept
    {
        swap(other);
        return *this;
    }
    ~Allocation();
    void swap(Allocation& other) noexcept;

    VkDeviceMemory memory() const;
    VkDeviceSize offset() const { return offset_; }
    VkDeviceSize size() const { return size_; }
    void* mapped() const; // nullptr unless host-visible

private:
    friend class MemoryAllocator;

    MemoryAllocator* allocator_ = nullptr;
    struct MemoryBlock* block_ = nullptr;
    VkDeviceSize offset_ = 0, size_ = 0;
    MemoryKind kind_ = MemoryKind::count;
};

struct MemoryBlock {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize size = 0;
    uint32_t type = 0;
    bool linear = true; // buffers; images live in blocks of their own (bufferImageGranularity)
    std::byte* mapped = nullptr;
    std::map<VkDeviceSize, VkDeviceSize> free; // offset -> size
};

class MemoryAllocator {
public:
    // $VKPT_FILL_MEMORY, a number from 0 to 255: bytes that host-visible memory holds until it is written. No image
    // may depend on it.
    explicit MemoryAllocator(const Device& device);
    ~MemoryAllocator();
    MemoryAllocator(const MemoryAllocator&) = delete;
    MemoryAllocator& operator=(const MemoryAllocator&) = delete;

    // Called where memory does not suffice, before the last attempt: gives back what it can, and leaves nothing
    // recorded that uses what the failure is going to destroy.
    void set_relief(std::function<void()> relief) { relief_ = std::move(relief); }
    // Throws LevelError: out of memory, naming kind and size.
    // Where one type of memory is full, the next that serves is taken.
    Allocation allocate(const VkMemoryRequirements& requirements, const MemoryWish& wish, bool linear, MemoryKind kind);
    uint64_t bytes_in_use(MemoryKind kind) const { return in_use_[size_t(kind)]; }

private:
    friend class Allocation;
    bool find_place(Allocation& allocation, VkDeviceSize alignment, uint32_t type, bool linear);
    bool add_place(Allocation& allocation, VkDeviceSize block_bytes, uint32_t type, bool linear);
    MemoryBlock* add_block(VkDeviceSize size, uint32_t type, bool linear); // nullptr: not to be had
    void release(Allocation& allocation);

    const Device& device_;
    std::optional<int> fill_;
    std::function<void()> relief_;
    std::list<MemoryBlock> blocks_;
    std::array<uint64_t, size_t(MemoryKind::count)> in_use_ {};
};

} // namespace vkpt
