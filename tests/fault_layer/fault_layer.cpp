// SPDX-License-Identifier: GPL-2.0-or-later
// A Vulkan layer for tests. While there is a file $VKPT_FAULTS, calls fail as its text says, a fault a line:
//   memory N   all allocations of device memory but the next N
//   surface    the window's surface is lost, once: whatever uses that surface fails until it is destroyed
//   surface formats, surface modes   the same, from the question for those on
//   format N   windows have no format but VkFormat N
//   hdr N SPACE  they have B8G8R8A8, and VkFormat N of as many bits, which are shown as those, in VkColorSpaceKHR SPACE
//   suboptimal every picture that is shown is said not to be the best for its window
//   slow N     the compilation of a pipeline takes N ms longer
//   lost       the device is lost, once: the next submission is run, and fails, as does all waiting
// and those that are read where an instance is made, and last as long as it:
//   gpu N      the device is a GPU with memory of its own, of which the CPU sees N MiB
//   compute    its queues are for compute and transfers alone
//   untimed    its queues have no timestamps
//   async      it has a second family of queues, for compute alone, which is the first queue under another name
//   portable   it lacks parts of Vulkan, as devices by way of MoltenVK do
// The layer keeps one table of functions: every device of a test is the same driver's.
#include "tests/fault_layer/fault_counts.hpp"

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

namespace {

std::mutex mutex;
PFN_vkGetInstanceProcAddr next_instance_function;
PFN_vkGetDeviceProcAddr next_device_function;
VkInstance instance;
VkDevice device; // the last one made
VkSurfaceKHR shown, lost; // of the newest swapchain; that fails now
std::string last_limit; // of allocations, that `allowed` counts for
long allowed;
bool device_lost;
vkpt::tests::FaultCounts counts;

struct Pretended {
    bool is_gpu = false, computes_only = false, is_untimed = false, is_async = false, is_portable = false;
    VkDeviceSize seen_bytes = 0; // of its memory, by the CPU
} pretended;

// Of the queues of the family that is pretended.
struct Async {
    uint32_t family = VK_QUEUE_FAMILY_IGNORED;
    std::set<VkCommandPool> pools;
    std::set<VkCommandBuffer> commands;
    std::set<VkFence> unfinished; // of the other queue: that nobody has waited for since they were submitted
} async;

// What stands behind the fault's name; "-": there is no such fault now.
std::string read_fault(std::string_view name)
{
    const char* path = std::getenv("VKPT_FAULTS");
    std::ifstream file(path ? path : "");
    for (std::string line; std::getline(file, line);)
        if (line == name || line.starts_with(std::string(name) + " "))
            return line.substr(std::min(line.size(), name.size() + 1));
    return "-";
}
bool has_fault(std::string_view name) { return read_fault(name) != "-"; }

bool fails_to_allocate()
{
    const std::scoped_lock lock(mutex);
    const std::string limit = read_fault("memory");
    if (limit != last_limit && limit != "-")
        allowed = std::atol(limit.c_str());
    last_limit = limit;
    return limit != "-" && allowed-- <= 0;
}

// `question`: that is asked now; empty: another one.
bool is_lost(VkSurfaceKHR surface, std::string_view question = "")
{
    const std::scoped_lock lock(mutex);
    const std::string first = read_fault("surface");
    if (shown && (first.empty() || first == question)) {
        unlink(std::getenv("VKPT_FAULTS"));
        lost = shown;
    }
    return surface && surface == lost;
}

template <class Function> Function of_instance(const char* name)
{
    return reinterpret_cast<Function>(next_instance_function(instance, name));
}
template <class Function> Function of_device(const char* name)
{
    return reinterpret_cast<Function>(next_device_function(device, name));
}

constexpr const char* portability_subset = "VK_KHR_portability_subset";

template <class Info> Info* find_link(const void* chain, VkStructureType type)
{
    auto* info = static_cast<Info*>(const_cast<void*>(chain));
    while (info && !(info->sType == type && info->function == VK_LAYER_LINK_INFO))
        info = static_cast<Info*>(const_cast<void*>(info->pNext));
    return info;
}

VkResult VKAPI_CALL create_instance(
    const VkInstanceCreateInfo* info, const VkAllocationCallbacks* callbacks, VkInstance* made)
{
    auto* link = find_link<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    next_instance_function = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create
        = reinterpret_cast<PFN_vkCreateInstance>(next_instance_function(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, callbacks, made);
    if (result == VK_SUCCESS)
        instance = *made;
    const std::string seen = read_fault("gpu");
    pretended = { seen != "-", has_fault("compute"), has_fault("untimed"), has_fault("async"), has_fault("portable"),
        VkDeviceSize(std::atol(seen.c_str())) << 20 };
    counts = {};
    async = {};
    counts.lists_portable = (info->flags & VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR) != 0;
    return result;
}

VkResult VKAPI_CALL create_device(
    VkPhysicalDevice physical, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* callbacks, VkDevice* made)
{
    const std::scoped_lock lock(mutex);
    auto* link = find_link<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    next_device_function = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    // The driver has no such extension.
    std::vector<const char*> names(
        info->ppEnabledExtensionNames, info->ppEnabledExtensionNames + info->enabledExtensionCount);
    counts.enables_portable |= std::erase_if(names, [](const char* name) {
        return pretended.is_portable && !std::strcmp(name, portability_subset);
    }) > 0;
    VkDeviceCreateInfo changed = *info;
    changed.enabledExtensionCount = uint32_t(names.size());
    changed.ppEnabledExtensionNames = names.data();
    changed.queueCreateInfoCount = 1; // the driver has no other family
    const VkResult result = of_instance<PFN_vkCreateDevice>("vkCreateDevice")(physical, &changed, callbacks, made);
    if (result == VK_SUCCESS) {
        device = *made;
        device_lost = false;
    }
    return result;
}

// ---- a GPU's memory: out of the CPU's sight, the CPU's own, and a part that both see

enum MemoryType : uint32_t { hidden_memory, host_memory, seen_memory, memory_types };
struct Allocated {
    uint32_t type;
    VkDeviceSize bytes;
};
std::map<VkDeviceMemory, Allocated> allocated;
VkDeviceSize seen_in_use;

PFN_vkGetPhysicalDeviceMemoryProperties next_memory_properties;
void VKAPI_CALL get_memory_properties(VkPhysicalDevice physical, VkPhysicalDeviceMemoryProperties* properties)
{
    next_memory_properties(physical, properties);
    if (!pretended.is_gpu)
        return;
    constexpr VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                    mapped = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkDeviceSize bytes = properties->memoryHeaps[0].size;
    *properties = { memory_types,
        { { local, 0 }, { mapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, 1 }, { local | mapped, 2 } }, 3,
        { { bytes, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT }, { bytes, 0 },
            { pretended.seen_bytes, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT } } };
}

PFN_vkGetPhysicalDeviceProperties2 next_properties;
void VKAPI_CALL get_properties(VkPhysicalDevice physical, VkPhysicalDeviceProperties2* properties)
{
    next_properties(physical, properties);
    if (pretended.is_gpu)
        properties->properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
}

void widen(VkMemoryRequirements* requirements)
{
    if (pretended.is_gpu)
        requirements->memoryTypeBits = (1u << memory_types) - 1;
}

PFN_vkGetBufferMemoryRequirements next_buffer_requirements;
void VKAPI_CALL get_buffer_requirements(VkDevice of, VkBuffer buffer, VkMemoryRequirements* requirements)
{
    next_buffer_requirements(of, buffer, requirements);
    widen(requirements);
}

PFN_vkGetImageMemoryRequirements next_image_requirements;
void VKAPI_CALL get_image_requirements(VkDevice of, VkImage image, VkMemoryRequirements* requirements)
{
    next_image_requirements(of, image, requirements);
    widen(requirements);
}

PFN_vkAllocateMemory next_allocate;
VkResult VKAPI_CALL allocate_memory(
    VkDevice of, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* callbacks, VkDeviceMemory* made)
{
    if (fails_to_allocate())
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (!pretended.is_gpu)
        return next_allocate(of, info, callbacks, made);
    const std::scoped_lock lock(mutex);
    const bool is_seen = info->memoryTypeIndex == seen_memory;
    if (is_seen && seen_in_use + info->allocationSize > pretended.seen_bytes) {
        counts.refused_allocations++;
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    VkMemoryAllocateInfo changed = *info;
    changed.memoryTypeIndex = 0;
    const VkResult result = next_allocate(of, &changed, callbacks, made);
    if (result == VK_SUCCESS) {
        allocated[*made] = { info->memoryTypeIndex, info->allocationSize };
        seen_in_use += is_seen ? info->allocationSize : 0;
        counts.hidden_bytes += info->memoryTypeIndex == hidden_memory ? info->allocationSize : 0;
    }
    return result;
}

PFN_vkFreeMemory next_free;
void VKAPI_CALL free_memory(VkDevice of, VkDeviceMemory memory, const VkAllocationCallbacks* callbacks)
{
    {
        const std::scoped_lock lock(mutex);
        if (const auto found = allocated.find(memory); found != allocated.end()) {
            seen_in_use -= found->second.type == seen_memory ? found->second.bytes : 0;
            allocated.erase(found);
        }
    }
    next_free(of, memory, callbacks);
}

PFN_vkMapMemory next_map;
VkResult VKAPI_CALL map_memory(
    VkDevice of, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize bytes, VkMemoryMapFlags flags, void** mapped)
{
    {
        const std::scoped_lock lock(mutex);
        if (const auto found = allocated.find(memory); found != allocated.end() && found->second.type == hidden_memory)
            return VK_ERROR_MEMORY_MAP_FAILED;
    }
    return next_map(of, memory, offset, bytes, flags, mapped);
}

// ---- queues and extensions

PFN_vkGetDeviceQueue next_get_queue;
void VKAPI_CALL get_queue(VkDevice of, uint32_t family, uint32_t index, VkQueue* queue)
{
    next_get_queue(of, family == async.family ? 0 : family, index, queue);
}

PFN_vkCreateCommandPool next_create_pool;
VkResult VKAPI_CALL create_pool(
    VkDevice of, const VkCommandPoolCreateInfo* info, const VkAllocationCallbacks* callbacks, VkCommandPool* made)
{
    VkCommandPoolCreateInfo changed = *info;
    changed.queueFamilyIndex = 0;
    const VkResult result = next_create_pool(of, &changed, callbacks, made);
    const std::scoped_lock lock(mutex);
    if (result == VK_SUCCESS && info->queueFamilyIndex == async.family)
        async.pools.insert(*made);
    return result;
}

PFN_vkAllocateCommandBuffers next_allocate_commands;
VkResult VKAPI_CALL allocate_commands(VkDevice of, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* made)
{
    const VkResult result = next_allocate_commands(of, info, made);
    const std::scoped_lock lock(mutex);
    if (result == VK_SUCCESS && async.pools.contains(info->commandPool))
        async.commands.insert(made, made + info->commandBufferCount);
    return result;
}

PFN_vkCreateBuffer next_create_buffer;
VkResult VKAPI_CALL create_buffer(
    VkDevice of, const VkBufferCreateInfo* info, const VkAllocationCallbacks* callbacks, VkBuffer* made)
{
    VkBufferCreateInfo changed = *info;
    if (pretended.is_async)
        changed.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    return next_create_buffer(of, &changed, callbacks, made);
}

void count_submission(const VkSubmitInfo& info, VkFence fence)
{
    const std::scoped_lock lock(mutex);
    if (info.commandBufferCount > 0 && async.commands.contains(info.pCommandBuffers[0])) {
        counts.async_submissions++;
        counts.async_beside_a_frame += info.waitSemaphoreCount == 0 && !async.unfinished.empty();
    } else {
        counts.frames_after_async += info.waitSemaphoreCount == 1 && counts.async_submissions > 0;
        if (fence)
            async.unfinished.insert(fence);
    }
}

PFN_vkGetPhysicalDeviceQueueFamilyProperties next_families;
void VKAPI_CALL get_families(VkPhysicalDevice physical, uint32_t* count, VkQueueFamilyProperties* families)
{
    const uint32_t room = *count;
    next_families(physical, count, families);
    if (pretended.is_async && (!families || room > *count)) {
        if (families)
            families[*count] = { VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT, 1, 64, { 1, 1, 1 } };
        async.family = (*count)++;
    }
    for (uint32_t i = 0; families && i < *count; i++) {
        if (pretended.computes_only)
            families[i].queueFlags = VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT;
        if (pretended.is_untimed)
            families[i].timestampValidBits = 0;
    }
}

PFN_vkEnumerateDeviceExtensionProperties next_extensions;
VkResult VKAPI_CALL enumerate_extensions(
    VkPhysicalDevice physical, const char* layer, uint32_t* count, VkExtensionProperties* extensions)
{
    if (!pretended.is_portable || layer)
        return next_extensions(physical, layer, count, extensions);
    uint32_t room = extensions && *count > 0 ? *count - 1 : 0;
    const VkResult result = next_extensions(physical, layer, &room, extensions);
    if (extensions && *count > 0) {
        extensions[room] = { "", 1 };
        std::strcpy(extensions[room].extensionName, portability_subset);
    }
    *count = room + 1;
    return result;
}

PFN_vkCreateComputePipelines next_pipelines;
VkResult VKAPI_CALL create_pipelines(VkDevice of, VkPipelineCache cache, uint32_t count,
    const VkComputePipelineCreateInfo* infos, const VkAllocationCallbacks* callbacks, VkPipeline* pipelines)
{
    if (const std::string slow = read_fault("slow"); slow != "-")
        std::this_thread::sleep_for(std::chrono::milliseconds(std::atol(slow.c_str())));
    return next_pipelines(of, cache, count, infos, callbacks, pipelines);
}

// ---- a device that is lost

PFN_vkDeviceWaitIdle next_wait_idle;
VkResult VKAPI_CALL wait_idle(VkDevice of)
{
    {
        const std::scoped_lock lock(mutex);
        async.unfinished.clear();
    }
    return device_lost ? VK_ERROR_DEVICE_LOST : next_wait_idle(of);
}

PFN_vkQueueSubmit next_submit;
VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo* infos, VkFence fence)
{
    if (!device_lost && has_fault("lost")) {
        unlink(std::getenv("VKPT_FAULTS"));
        next_submit(queue, count, infos, fence);
        next_wait_idle(device);
        device_lost = true;
        counts.losses++;
    }
    counts.submissions += count;
    for (uint32_t i = 0; pretended.is_async && i < count; i++)
        count_submission(infos[i], fence);
    return device_lost ? VK_ERROR_DEVICE_LOST : next_submit(queue, count, infos, fence);
}

PFN_vkQueueWaitIdle next_queue_wait_idle;
VkResult VKAPI_CALL queue_wait_idle(VkQueue queue)
{
    return device_lost ? VK_ERROR_DEVICE_LOST : next_queue_wait_idle(queue);
}

PFN_vkWaitForFences next_wait;
VkResult VKAPI_CALL wait_for_fences(VkDevice of, uint32_t count, const VkFence* fences, VkBool32 all, uint64_t limit)
{
    for (uint32_t i = 0; i < count; i++) {
        const std::scoped_lock lock(mutex);
        async.unfinished.erase(fences[i]);
    }
    return device_lost ? VK_ERROR_DEVICE_LOST : next_wait(of, count, fences, all, limit);
}

PFN_vkCmdWriteTimestamp next_timestamp;
void VKAPI_CALL write_timestamp(
    VkCommandBuffer commands, VkPipelineStageFlagBits stage, VkQueryPool pool, uint32_t query)
{
    counts.timestamps++;
    next_timestamp(commands, stage, pool, query);
}

// ---- windows

constexpr VkSurfaceFormatKHR plain_format { VK_FORMAT_B8G8R8A8_UNORM, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR };

PFN_vkCreateSwapchainKHR next_create_swapchain;
VkResult VKAPI_CALL create_swapchain(
    VkDevice of, const VkSwapchainCreateInfoKHR* info, const VkAllocationCallbacks* callbacks, VkSwapchainKHR* made)
{
    if (is_lost(info->surface))
        return VK_ERROR_SURFACE_LOST_KHR;
    shown = info->surface;
    counts.swapchains++;
    VkSwapchainCreateInfoKHR changed = *info;
    if (info->imageColorSpace != plain_format.colorSpace) {
        changed.imageFormat = plain_format.format;
        changed.imageColorSpace = plain_format.colorSpace;
    }
    return next_create_swapchain(of, &changed, callbacks, made);
}

PFN_vkAcquireNextImageKHR next_acquire;
VkResult VKAPI_CALL acquire(
    VkDevice of, VkSwapchainKHR swapchain, uint64_t limit, VkSemaphore semaphore, VkFence fence, uint32_t* picture)
{
    counts.acquired++;
    counts.submissions_before_acquire = counts.submissions;
    return is_lost(shown) ? VK_ERROR_SURFACE_LOST_KHR : next_acquire(of, swapchain, limit, semaphore, fence, picture);
}

PFN_vkQueuePresentKHR next_present;
VkResult VKAPI_CALL present(VkQueue queue, const VkPresentInfoKHR* info)
{
    const VkResult result = next_present(queue, info);
    counts.presented++;
    return result == VK_SUCCESS && has_fault("suboptimal") ? VK_SUBOPTIMAL_KHR : result;
}

PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR next_capabilities;
VkResult VKAPI_CALL get_capabilities(
    VkPhysicalDevice physical, VkSurfaceKHR surface, VkSurfaceCapabilitiesKHR* capabilities)
{
    return is_lost(surface) ? VK_ERROR_SURFACE_LOST_KHR : next_capabilities(physical, surface, capabilities);
}

PFN_vkGetPhysicalDeviceSurfaceFormatsKHR next_formats;
VkResult VKAPI_CALL get_formats(
    VkPhysicalDevice physical, VkSurfaceKHR surface, uint32_t* count, VkSurfaceFormatKHR* formats)
{
    if (is_lost(surface, "formats"))
        return VK_ERROR_SURFACE_LOST_KHR;
    const std::string format = read_fault("format"), hdr = read_fault("hdr");
    std::vector<VkSurfaceFormatKHR> offered;
    if (format != "-")
        offered = { { VkFormat(std::atoi(format.c_str())), plain_format.colorSpace } };
    else if (char* space = nullptr; hdr != "-") {
        const long number = std::strtol(hdr.c_str(), &space, 10);
        offered = { plain_format, { VkFormat(number), VkColorSpaceKHR(std::atol(space)) } };
    } else
        return next_formats(physical, surface, count, formats);
    if (formats)
        std::copy_n(offered.begin(), std::min<size_t>(*count, offered.size()), formats);
    *count = uint32_t(offered.size());
    return VK_SUCCESS;
}

PFN_vkGetPhysicalDeviceSurfacePresentModesKHR next_modes;
VkResult VKAPI_CALL get_modes(VkPhysicalDevice physical, VkSurfaceKHR surface, uint32_t* count, VkPresentModeKHR* modes)
{
    return is_lost(surface, "modes") ? VK_ERROR_SURFACE_LOST_KHR : next_modes(physical, surface, count, modes);
}

PFN_vkDestroySurfaceKHR next_destroy_surface;
void VKAPI_CALL destroy_surface(VkInstance of, VkSurfaceKHR surface, const VkAllocationCallbacks* callbacks)
{
    if (surface == shown)
        shown = VK_NULL_HANDLE;
    if (surface == lost)
        lost = VK_NULL_HANDLE;
    next_destroy_surface(of, surface, callbacks);
}

// Ours in place of `next`, which is kept; nullptr where there is none.
template <class Function> PFN_vkVoidFunction take(Function& kept, Function ours, PFN_vkVoidFunction next)
{
    if (!next)
        return nullptr;
    kept = reinterpret_cast<Function>(next);
    return reinterpret_cast<PFN_vkVoidFunction>(ours);
}

PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice of, const char* name)
{
    if (!std::strcmp(name, "vkGetDeviceProcAddr"))
        return reinterpret_cast<PFN_vkVoidFunction>(get_device_function);
    const PFN_vkVoidFunction next = next_device_function(of, name);
#define VKPT_TAKE(called, kept, ours)                                                                                  \
    if (!std::strcmp(name, called))                                                                                    \
        return take(kept, ours, next);
    VKPT_TAKE("vkGetDeviceQueue", next_get_queue, get_queue)
    VKPT_TAKE("vkCreateCommandPool", next_create_pool, create_pool)
    VKPT_TAKE("vkAllocateCommandBuffers", next_allocate_commands, allocate_commands)
    VKPT_TAKE("vkCreateBuffer", next_create_buffer, create_buffer)
    VKPT_TAKE("vkAllocateMemory", next_allocate, allocate_memory)
    VKPT_TAKE("vkFreeMemory", next_free, free_memory)
    VKPT_TAKE("vkMapMemory", next_map, map_memory)
    VKPT_TAKE("vkGetBufferMemoryRequirements", next_buffer_requirements, get_buffer_requirements)
    VKPT_TAKE("vkGetImageMemoryRequirements", next_image_requirements, get_image_requirements)
    VKPT_TAKE("vkCreateComputePipelines", next_pipelines, create_pipelines)
    VKPT_TAKE("vkDeviceWaitIdle", next_wait_idle, wait_idle)
    VKPT_TAKE("vkQueueSubmit", next_submit, submit)
    VKPT_TAKE("vkQueueWaitIdle", next_queue_wait_idle, queue_wait_idle)
    VKPT_TAKE("vkWaitForFences", next_wait, wait_for_fences)
    VKPT_TAKE("vkCmdWriteTimestamp", next_timestamp, write_timestamp)
    VKPT_TAKE("vkCreateSwapchainKHR", next_create_swapchain, create_swapchain)
    VKPT_TAKE("vkAcquireNextImageKHR", next_acquire, acquire)
    VKPT_TAKE("vkQueuePresentKHR", next_present, present)
    return next;
}

PFN_vkVoidFunction VKAPI_CALL get_instance_function(VkInstance of, const char* name)
{
    if (!std::strcmp(name, "vkGetInstanceProcAddr"))
        return reinterpret_cast<PFN_vkVoidFunction>(get_instance_function);
    if (!std::strcmp(name, "vkCreateInstance"))
        return reinterpret_cast<PFN_vkVoidFunction>(create_instance);
    if (!std::strcmp(name, "vkCreateDevice"))
        return reinterpret_cast<PFN_vkVoidFunction>(create_device);
    if (!std::strcmp(name, "vkGetDeviceProcAddr"))
        return reinterpret_cast<PFN_vkVoidFunction>(get_device_function);
    if (!next_instance_function)
        return nullptr;
    const PFN_vkVoidFunction next = next_instance_function(of, name);
    VKPT_TAKE("vkGetPhysicalDeviceProperties2", next_properties, get_properties)
    VKPT_TAKE("vkGetPhysicalDeviceMemoryProperties", next_memory_properties, get_memory_properties)
    VKPT_TAKE("vkGetPhysicalDeviceQueueFamilyProperties", next_families, get_families)
    VKPT_TAKE("vkEnumerateDeviceExtensionProperties", next_extensions, enumerate_extensions)
    VKPT_TAKE("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", next_capabilities, get_capabilities)
    VKPT_TAKE("vkGetPhysicalDeviceSurfaceFormatsKHR", next_formats, get_formats)
    VKPT_TAKE("vkGetPhysicalDeviceSurfacePresentModesKHR", next_modes, get_modes)
    VKPT_TAKE("vkDestroySurfaceKHR", next_destroy_surface, destroy_surface)
#undef VKPT_TAKE
    return next;
}

} // namespace

extern "C" [[gnu::visibility("default")]] VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(
    VkNegotiateLayerInterface* versions)
{
    versions->loaderLayerInterfaceVersion = 2;
    versions->pfnGetInstanceProcAddr = get_instance_function;
    versions->pfnGetDeviceProcAddr = get_device_function;
    versions->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}

extern "C" [[gnu::visibility("default")]] void vkpt_fault_counts(vkpt::tests::FaultCounts* out) { *out = counts; }
