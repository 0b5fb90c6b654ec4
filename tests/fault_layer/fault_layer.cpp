// SPDX-License-Identifier: GPL-2.0-or-later
// A Vulkan layer for tests. While there is a file $VKPT_FAULTS, calls fail as its text says:
//   memory N   all allocations of device memory but the next N
//   surface    the window's surface is lost, once: whatever uses that surface fails until it is destroyed
//   format N   windows have no format but VkFormat N
// The layer keeps one table of functions: every device of a test is the same driver's.
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <mutex>
#include <string>
#include <unistd.h>

namespace {

std::mutex mutex;
PFN_vkGetInstanceProcAddr next_instance_function;
PFN_vkGetDeviceProcAddr next_device_function;
VkInstance instance;
VkDevice device; // the last one made
VkSurfaceKHR shown, lost; // of the newest swapchain; that fails now
std::string last_fault; // that `allowed` counts for
long allowed;

std::string read_fault()
{
    const char* path = std::getenv("VKPT_FAULTS");
    std::ifstream file(path ? path : "");
    std::string text;
    std::getline(file, text);
    return text;
}

bool fails_to_allocate()
{
    constexpr std::string_view memory = "memory ";
    const std::scoped_lock lock(mutex);
    const std::string fault = read_fault();
    if (fault != last_fault && fault.starts_with(memory))
        allowed = std::atol(fault.c_str() + memory.size());
    last_fault = fault;
    return fault.starts_with(memory) && allowed-- <= 0;
}

bool is_lost(VkSurfaceKHR surface)
{
    const std::scoped_lock lock(mutex);
    if (shown && read_fault() == "surface") {
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
    return result;
}

VkResult VKAPI_CALL create_device(
    VkPhysicalDevice physical, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* callbacks, VkDevice* made)
{
    const std::scoped_lock lock(mutex);
    auto* link = find_link<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    next_device_function = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult result = of_instance<PFN_vkCreateDevice>("vkCreateDevice")(physical, info, callbacks, made);
    if (result == VK_SUCCESS)
        device = *made;
    return result;
}

PFN_vkAllocateMemory next_allocate;
VkResult VKAPI_CALL allocate_memory(
    VkDevice of, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* callbacks, VkDeviceMemory* made)
{
    return fails_to_allocate() ? VK_ERROR_OUT_OF_DEVICE_MEMORY : next_allocate(of, info, callbacks, made);
}

PFN_vkCreateSwapchainKHR next_create_swapchain;
VkResult VKAPI_CALL create_swapchain(
    VkDevice of, const VkSwapchainCreateInfoKHR* info, const VkAllocationCallbacks* callbacks, VkSwapchainKHR* made)
{
    if (is_lost(info->surface))
        return VK_ERROR_SURFACE_LOST_KHR;
    shown = info->surface;
    return next_create_swapchain(of, info, callbacks, made);
}

PFN_vkAcquireNextImageKHR next_acquire;
VkResult VKAPI_CALL acquire(
    VkDevice of, VkSwapchainKHR swapchain, uint64_t limit, VkSemaphore semaphore, VkFence fence, uint32_t* picture)
{
    return is_lost(shown) ? VK_ERROR_SURFACE_LOST_KHR : next_acquire(of, swapchain, limit, semaphore, fence, picture);
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
    constexpr std::string_view format = "format ";
    const std::string fault = read_fault();
    if (!fault.starts_with(format))
        return next_formats(physical, surface, count, formats);
    if (formats && *count > 0)
        formats[0] = { VkFormat(std::atoi(fault.c_str() + format.size())), VK_COLOR_SPACE_SRGB_NONLINEAR_KHR };
    *count = 1;
    return VK_SUCCESS;
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
    if (!std::strcmp(name, "vkAllocateMemory"))
        return take(next_allocate, allocate_memory, next);
    if (!std::strcmp(name, "vkCreateSwapchainKHR"))
        return take(next_create_swapchain, create_swapchain, next);
    if (!std::strcmp(name, "vkAcquireNextImageKHR"))
        return take(next_acquire, acquire, next);
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
    if (!std::strcmp(name, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR"))
        return take(next_capabilities, get_capabilities, next);
    if (!std::strcmp(name, "vkGetPhysicalDeviceSurfaceFormatsKHR"))
        return take(next_formats, get_formats, next);
    if (!std::strcmp(name, "vkDestroySurfaceKHR"))
        return take(next_destroy_surface, destroy_surface, next);
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
