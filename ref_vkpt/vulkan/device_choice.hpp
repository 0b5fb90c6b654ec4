// SPDX-License-Identifier: GPL-2.0-or-later
// What is decided from the facts that a machine's Vulkan drivers tell: device, queue family, memory types. Calls no
// driver.
#pragma once

#include "ref_vkpt/vulkan/functions.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vkpt {

struct DeviceFacts {
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    bool can_present = true; // to the window, if there is one
};

// The index of the best: one that can present before others, then GPUs with memory of their own, integrated, virtual,
// CPUs; of equal ones the first. Empty: there is none.
std::optional<size_t> choose_device(std::span<const DeviceFacts> devices);

// The families that serve, the best first: those for graphics, too, which every windowing system presents from, then
// those for compute alone.
std::vector<uint32_t> rank_queue_families(std::span<const VkQueueFamilyProperties> families);

struct QueuePlace {
    uint32_t family, index;
};
// A queue whose work may run beside that of the main family's first one: a family for compute alone, or else the main
// family's second queue.
std::optional<QueuePlace> find_async_queue(std::span<const VkQueueFamilyProperties> families, uint32_t main_family);

// Which memory serves: with all of `required`, better with `preferred`, and better without `avoided`.
struct MemoryWish {
    VkMemoryPropertyFlags required = 0, preferred = 0, avoided = 0;
};

// The memory types among `type_bits` that serve, the best first; of equal ones in the driver's order, which goes by
// speed. Without those that need a feature of the device we do not ask for.
std::vector<uint32_t> rank_memory_types(
    const VkPhysicalDeviceMemoryProperties& memory, uint32_t type_bits, const MemoryWish& wish);

// Whether the CPU can write to most of the device's memory. A discrete GPU without a resizable BAR shows 256 MiB.
bool maps_all_memory(const VkPhysicalDeviceMemoryProperties& memory);

// Between two timestamps of so many valid bits, the counter having wrapped around once at most.
uint64_t ticks_between(uint64_t begin, uint64_t end, uint32_t valid_bits);

} // namespace vkpt
