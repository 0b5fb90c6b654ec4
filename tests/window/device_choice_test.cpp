// SPDX-License-Identifier: GPL-2.0-or-later
// Which device, queues and memory are taken, of those that real drivers list.
#include "ref_vkpt/vulkan/device_choice.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr VkPhysicalDeviceType discrete = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU,
                               integrated = VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, cpu = VK_PHYSICAL_DEVICE_TYPE_CPU;

size_t choose(const std::vector<DeviceFacts>& devices) { return choose_device(devices).value_or(99); }

TEST(DeviceChoice, GoesByTheWindowThenByTheKind)
{
    EXPECT_FALSE(choose_device({}));
    EXPECT_EQ(choose({ { cpu, true }, { integrated, true }, { discrete, true } }), 2u);
    EXPECT_EQ(choose({ { discrete, false }, { integrated, true }, { cpu, true } }), 1u) << "the screen hangs on it";
    EXPECT_EQ(choose({ { discrete, false }, { cpu, false } }), 0u) << "then the window says so";
    EXPECT_EQ(choose({ { discrete, true }, { discrete, true } }), 0u);
}

TEST(QueueChoice, TakesGraphicsFirstAndComputeAlone)
{
    const auto family = [](VkQueueFlags flags, uint32_t count = 1) {
        return VkQueueFamilyProperties { flags, count, 64, { 1, 1, 1 } };
    };
    constexpr VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    const std::vector<VkQueueFamilyProperties> families { family(VK_QUEUE_TRANSFER_BIT),
        family(VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT), family(both), family(both, 0),
        family(VK_QUEUE_GRAPHICS_BIT) };
    EXPECT_EQ(rank_queue_families(families), (std::vector<uint32_t> { 2, 1 }));
    EXPECT_TRUE(rank_queue_families(std::vector { family(VK_QUEUE_GRAPHICS_BIT) }).empty());
}

TEST(QueueChoice, FindsASecondQueueForCompute)
{
    const auto family = [](VkQueueFlags flags, uint32_t count) {
        return VkQueueFamilyProperties { flags, count, 64, { 1, 1, 1 } };
    };
    constexpr VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT, compute = VK_QUEUE_COMPUTE_BIT;
    const auto find = [](const std::vector<VkQueueFamilyProperties>& families, uint32_t main) {
        const std::optional<QueuePlace> place = find_async_queue(families, main);
        return place ? std::pair(int(place->family), int(place->index)) : std::pair(-1, -1);
    };
    EXPECT_EQ(find({ family(both, 1), family(compute, 4) }, 0), std::pair(1, 0)) << "Radeon";
    EXPECT_EQ(find({ family(both, 16), family(VK_QUEUE_TRANSFER_BIT, 2), family(compute, 8) }, 0), std::pair(2, 0));
    EXPECT_EQ(find({ family(both, 4) }, 0), std::pair(0, 1)) << "one family of many queues";
    EXPECT_EQ(find({ family(both, 1), family(VK_QUEUE_TRANSFER_BIT, 1), family(compute, 0) }, 0), std::pair(-1, -1));
    EXPECT_EQ(find({ family(compute, 1) }, 0), std::pair(-1, -1));
}

constexpr VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                mapped = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                                cached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
constexpr VkDeviceSize gib = 1u << 30;

// As RADV lists a Radeon RX 6800 whose BAR is not resizable.
VkPhysicalDeviceMemoryProperties small_bar()
{
    VkPhysicalDeviceMemoryProperties memory {};
    const VkMemoryType types[] = { { local, 0 }, { mapped, 1 }, { local | mapped, 2 }, { mapped | cached, 1 },
        { local | VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD, 0 },
        { local | mapped | VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD, 2 } };
    for (const VkMemoryType& type : types)
        memory.memoryTypes[memory.memoryTypeCount++] = type;
    memory.memoryHeapCount = 3;
    memory.memoryHeaps[0] = { 16 * gib - (256u << 20), VK_MEMORY_HEAP_DEVICE_LOCAL_BIT };
    memory.memoryHeaps[1] = { 16 * gib, 0 };
    memory.memoryHeaps[2] = { 256u << 20, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT };
    return memory;
}

TEST(MemoryChoice, SeesWhetherTheBarIsSmall)
{
    VkPhysicalDeviceMemoryProperties memory = small_bar();
    EXPECT_FALSE(maps_all_memory(memory));
    memory.memoryTypes[2].heapIndex = 0; // resizable
    EXPECT_TRUE(maps_all_memory(memory));
    VkPhysicalDeviceMemoryProperties shared {}; // of a CPU, or a processor's GPU
    shared.memoryTypeCount = shared.memoryHeapCount = 1;
    shared.memoryTypes[0] = { local | mapped | cached, 0 };
    shared.memoryHeaps[0] = { gib, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT };
    EXPECT_TRUE(maps_all_memory(shared));
}

TEST(MemoryChoice, ListsWhatServesAndTheBestFirst)
{
    using Types = std::vector<uint32_t>;
    constexpr uint32_t all = 0x3f;
    EXPECT_EQ(rank_memory_types(small_bar(), all, { mapped, local, 0 }), (Types { 2, 1, 3 }))
        << "written, read by shaders";
    EXPECT_EQ(rank_memory_types(small_bar(), all, { mapped, 0, local }), (Types { 1, 3, 2 })) << "staging";
    EXPECT_EQ(rank_memory_types(small_bar(), all, { mapped, cached, local }), (Types { 3, 1, 2 })) << "read back";
    EXPECT_EQ(rank_memory_types(small_bar(), all, { local, 0, mapped }), (Types { 0, 2 })) << "the device's alone";
    EXPECT_EQ(rank_memory_types(small_bar(), 0x4, { local, 0, mapped }), (Types { 2 }));
    EXPECT_TRUE(rank_memory_types(small_bar(), 0x1, { mapped, 0, 0 }).empty());
}

TEST(Timestamps, WrapAroundAtTheirValidBits)
{
    EXPECT_EQ(ticks_between(5, 12, 64), 7u);
    EXPECT_EQ(ticks_between(0xffffffff0, 0x10, 36), 0x20u);
    EXPECT_EQ(ticks_between(UINT64_MAX - 1, 3, 64), 5u);
    EXPECT_EQ(ticks_between((uint64_t(7) << 40) + 5, (uint64_t(9) << 40) + 6, 36), 1u) << "bits that are not valid";
}

} // namespace
} // namespace vkpt::tests
