// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/memory.hpp"

#include "ref_vkpt/engine/errors.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <iterator>
#include <utility>

namespace vkpt {

namespace {

constexpr VkDeviceSize block_size = 32u << 20;

const char* describe(MemoryKind kind)
{
    constexpr const char* names[]
        = { "textures", "geometry", "acceleration structures", "lights", "images", "staging" };
    return names[size_t(kind)];
}

VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment) { return (value + alignment - 1) & ~(alignment - 1); }

// Cuts `size` bytes out of the block's free ranges.
std::optional<VkDeviceSize> cut(MemoryBlock& block, VkDeviceSize size, VkDeviceSize alignment)
{
    for (auto range = block.free.begin(); range != block.free.end(); ++range) {
        const auto [start, length] = *range;
        const VkDeviceSize offset = align_up(start, alignment);
        if (offset + size > start + length)
            continue;
        block.free.erase(range);
        if (offset > start)
            block.free[start] = offset - start;
        if (offset + size < start + length)
            block.free[offset + size] = start + length - offset - size;
        return offset;
    }
    return std::nullopt;
}

} // namespace

Allocation::~Allocation()
{
    if (allocator_)
        allocator_->release(*this);
}

VkDeviceMemory Allocation::memory() const { return block_->memory; }

void* Allocation::mapped() const { return block_->mapped ? block_->mapped + offset_ : nullptr; }

void Allocation::swap(Allocation& other) noexcept
{
    std::swap(allocator_, other.allocator_);
    std::swap(block_, other.block_);
    std::swap(offset_, other.offset_);
    std::swap(size_, other.size_);
    std::swap(kind_, other.kind_);
}

MemoryAllocator::MemoryAllocator(const Device& device)
    : device_(device)
{
    if (const char* wanted = std::getenv("VKPT_FILL_MEMORY"))
        fill_ = std::atoi(wanted) & 0xff;
}

MemoryAllocator::~MemoryAllocator()
{
    for (MemoryBlock& block : blocks_)
        vkFreeMemory(device_.handle, block.memory, nullptr);
}

bool MemoryAllocator::find_place(Allocation& allocation, VkDeviceSize alignment, uint32_t type, bool linear)
{
    for (MemoryBlock& block : blocks_)
        if (block.type == type && block.linear == linear)
            if (const std::optional<VkDeviceSize> offset = cut(block, allocation.size_, alignment)) {
                allocation.block_ = &block;
                allocation.offset_ = *offset;
                return true;
            }
    return false;
}

bool MemoryAllocator::add_place(Allocation& allocation, VkDeviceSize block_bytes, uint32_t type, bool linear)
{
    MemoryBlock* block = add_block(block_bytes, type, linear);
    if (!block)
        return false;
    allocation.block_ = block;
    allocation.offset_ = *cut(*block, allocation.size_, 1); // the begin of a block suits everything
    return true;
}

Allocation MemoryAllocator::allocate(
    const VkMemoryRequirements& requirements, const MemoryWish& wish, bool linear, MemoryKind kind)
{
    const std::vector<uint32_t> types = device_.find_memory_types(requirements.memoryTypeBits, wish);
    Allocation allocation;
    allocation.size_ = align_up(requirements.size, 256);
    allocation.kind_ = kind;
    const auto find = [&](uint32_t type) { return find_place(allocation, requirements.alignment, type, linear); };
    const auto add = [&](uint32_t type, VkDeviceSize bytes) { return add_place(allocation, bytes, type, linear); };
    const VkDeviceSize bytes = allocation.size_, roomy = std::max(block_size, bytes);
    bool found = std::ranges::any_of(
        types, [&](uint32_t type) { return find(type) || add(type, roomy) || (types.size() > 1 && add(type, bytes)); });
    if (!found && relief_) {
        relief_();
        found = std::ranges::any_of(types, find);
    }
    if (!found && !std::ranges::any_of(types, [&](uint32_t type) { return add(type, bytes); }))
        throw LevelError(fmt::format("out of memory on {}: cannot allocate {} MiB for {}; {}",
            device_.properties.deviceName, (bytes >> 20) + 1, describe(kind), memory_remedy));
    allocation.allocator_ = this;
    in_use_[size_t(kind)] += allocation.size_;
    if (fill_ && allocation.mapped())
        std::memset(allocation.mapped(), *fill_, allocation.size_);
    return allocation;
}

MemoryBlock* MemoryAllocator::add_block(VkDeviceSize size, uint32_t type, bool linear)
{
    VkMemoryAllocateFlagsInfo flags { VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO };
    if (linear)
        flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info { VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags };
    info.allocationSize = size;
    info.memoryTypeIndex = type;
    MemoryBlock block;
    if (vkAllocateMemory(device_.handle, &info, nullptr, &block.memory) < 0)
        return nullptr;
    block.size = size;
    block.type = type;
    block.linear = linear;
    block.free[0] = size;
    if (device_.memory.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
        void* mapped = nullptr;
        if (vkMapMemory(device_.handle, block.memory, 0, VK_WHOLE_SIZE, 0, &mapped) < 0) {
            vkFreeMemory(device_.handle, block.memory, nullptr);
            return nullptr;
        }
        block.mapped = static_cast<std::byte*>(mapped);
    }
    return &blocks_.emplace_back(std::move(block));
}

void MemoryAllocator::release(Allocation& allocation)
{
    MemoryBlock& block = *allocation.block_;
    in_use_[size_t(allocation.kind_)] -= allocation.size_;
    auto [range, inserted] = block.free.emplace(allocation.offset_, allocation.size_);
    if (auto next = std::next(range); next != block.free.end() && range->first + range->second == next->first) {
        range->second += next->second;
        block.free.erase(next);
    }
    if (range != block.free.begin())
        if (auto previous = std::prev(range); previous->first + previous->second == range->first) {
            previous->second += range->second;
            block.free.erase(range);
        }
    allocation.allocator_ = nullptr;
    if (block.free.size() == 1 && block.free.begin()->second == block.size) {
        vkFreeMemory(device_.handle, block.memory, nullptr);
        blocks_.remove_if([&](const MemoryBlock& candidate) { return &candidate == &block; });
    }
}

} // namespace vkpt
