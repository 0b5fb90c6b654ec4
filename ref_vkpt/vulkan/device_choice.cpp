// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/device_choice.hpp"

#include <algorithm>

namespace vkpt {

namespace {

int rank_device_type(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 1;
    default:
        return 0;
    }
}

int rank_device(const DeviceFacts& device) { return device.can_present * 8 + rank_device_type(device.type); }

// All that memory types without a feature of their own can have.
constexpr VkMemoryPropertyFlags plain_memory = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT
    | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

} // namespace

std::optional<size_t> choose_device(std::span<const DeviceFacts> devices)
{
    const auto best = std::ranges::max_element(devices, {}, rank_device);
    return best == devices.end() ? std::nullopt : std::optional(size_t(best - devices.begin()));
}

std::vector<uint32_t> rank_queue_families(std::span<const VkQueueFamilyProperties> families)
{
    std::vector<uint32_t> ranked;
    for (const VkQueueFlags wanted :
        { VkQueueFlags(VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT), VkQueueFlags(VK_QUEUE_COMPUTE_BIT) })
        for (uint32_t i = 0; i < families.size(); i++)
            if (families[i].queueCount > 0
                && (families[i].queueFlags & (VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT)) == wanted)
                ranked.push_back(i);
    return ranked;
}

std::optional<QueuePlace> find_async_queue(std::span<const VkQueueFamilyProperties> families, uint32_t main_family)
{
    for (uint32_t i = 0; i < families.size(); i++)
        if (i != main_family && families[i].queueCount > 0
            && (families[i].queueFlags & (VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT)) == VK_QUEUE_COMPUTE_BIT)
            return QueuePlace { i, 0 };
    if (families[main_family].queueCount > 1)
        return QueuePlace { main_family, 1 };
    return std::nullopt;
}

std::vector<uint32_t> rank_memory_types(
    const VkPhysicalDeviceMemoryProperties& memory, uint32_t type_bits, const MemoryWish& wish)
{
    std::vector<uint32_t> ranked;
    const auto flags = [&](uint32_t type) { return memory.memoryTypes[type].propertyFlags; };
    for (uint32_t type = 0; type < memory.memoryTypeCount; type++)
        if ((type_bits >> type & 1) && (flags(type) & wish.required) == wish.required && !(flags(type) & ~plain_memory))
            ranked.push_back(type);
    std::ranges::stable_sort(ranked, std::ranges::greater(), [&](uint32_t type) {
        return 2 * ((flags(type) & wish.preferred) == wish.preferred) + !(flags(type) & wish.avoided);
    });
    return ranked;
}

bool maps_all_memory(const VkPhysicalDeviceMemoryProperties& memory)
{
    constexpr VkMemoryPropertyFlags mapped = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT
        | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkDeviceSize all = 0, seen = 0;
    for (uint32_t type = 0; type < memory.memoryTypeCount; type++) {
        const VkDeviceSize bytes = memory.memoryHeaps[memory.memoryTypes[type].heapIndex].size;
        if (memory.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)
            all = std::max(all, bytes);
        if ((memory.memoryTypes[type].propertyFlags & mapped) == mapped)
            seen = std::max(seen, bytes);
    }
    return seen >= all / 2;
}

uint64_t ticks_between(uint64_t begin, uint64_t end, uint32_t valid_bits)
{
    const uint64_t mask = valid_bits >= 64 ? ~uint64_t(0) : (uint64_t(1) << valid_bits) - 1;
    return (end - begin) & mask;
}

} // namespace vkpt
