// SPDX-License-Identifier: GPL-2.0-or-later
// A Vulkan layer that notes which work a program records into its command buffers, and which barriers between. Data
// that goes by buffer addresses is nothing that the validation layers could follow.
#include "tests/module/recording_layer.hpp"

#include <vulkan/vk_layer.h>

#include <cstring>
#include <map>
#include <mutex>
#include <utility>

namespace vkpt::tests {
namespace {

// All objects of a device, and those of an instance, start with a pointer to the loader's table.
void* key_of(const void* handle) { return *static_cast<void* const*>(handle); }

std::mutex mutex;
std::map<void*, PFN_vkGetInstanceProcAddr> instances;
struct Next {
    VkDevice device;
    PFN_vkGetDeviceProcAddr get_function;
};
std::map<void*, Next> devices;
void* recorded_device = nullptr;
std::map<VkCommandBuffer, RecordedCommands> recording;
std::map<VkCommandBuffer, std::string> labels; // open ones; they do not nest
std::vector<RecordedCommands> submitted;

template <class Function, class Handle> Function next_device_function(Handle handle, const char* name)
{
    const std::lock_guard lock(mutex);
    const Next& next = devices.at(key_of(handle));
    return reinterpret_cast<Function>(next.get_function(next.device, name));
}

void note(VkCommandBuffer commands, const RecordedCommand& command)
{
    const std::lock_guard lock(mutex);
    if (key_of(commands) == recorded_device)
        recording[commands].push_back(command);
    if (const auto label = labels.find(commands); label != labels.end() && key_of(commands) == recorded_device)
        recording[commands].back().label = label->second;
}

RecordedCommand make_barrier(
    VkPipelineStageFlags from, VkPipelineStageFlags to, VkAccessFlags from_access, VkAccessFlags to_access, bool global)
{
    return { RecordedCommand::barrier, from, to, from_access, to_access, global, {} };
}

#define VKPT_NEXT(handle, name) next_device_function<PFN_##name>(handle, #name)

VKAPI_ATTR VkResult VKAPI_CALL begin_commands(VkCommandBuffer commands, const VkCommandBufferBeginInfo* info)
{
    {
        const std::lock_guard lock(mutex);
        recording[commands].clear();
    }
    return VKPT_NEXT(commands, vkBeginCommandBuffer)(commands, info);
}

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo* infos, VkFence fence)
{
    {
        const std::lock_guard lock(mutex);
        for (uint32_t i = 0; i < count && key_of(queue) == recorded_device; i++)
            for (uint32_t j = 0; j < infos[i].commandBufferCount; j++)
                submitted.push_back(recording[infos[i].pCommandBuffers[j]]);
    }
    return VKPT_NEXT(queue, vkQueueSubmit)(queue, count, infos, fence);
}

VKAPI_ATTR void VKAPI_CALL pipeline_barrier(VkCommandBuffer commands, VkPipelineStageFlags from,
    VkPipelineStageFlags to, VkDependencyFlags flags, uint32_t memory_count, const VkMemoryBarrier* memory,
    uint32_t buffer_count, const VkBufferMemoryBarrier* buffers, uint32_t image_count,
    const VkImageMemoryBarrier* images)
{
    for (uint32_t i = 0; i < memory_count; i++)
        note(commands, make_barrier(from, to, memory[i].srcAccessMask, memory[i].dstAccessMask, true));
    for (uint32_t i = 0; i < image_count; i++)
        note(commands, make_barrier(from, to, images[i].srcAccessMask, images[i].dstAccessMask, false));
    VKPT_NEXT(commands, vkCmdPipelineBarrier)
    (commands, from, to, flags, memory_count, memory, buffer_count, buffers, image_count, images);
}

VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y, uint32_t z)
{
    note(commands, { .kind = RecordedCommand::dispatch });
    VKPT_NEXT(commands, vkCmdDispatch)(commands, x, y, z);
}

VKAPI_ATTR void VKAPI_CALL trace_rays(VkCommandBuffer commands, const VkStridedDeviceAddressRegionKHR* generation,
    const VkStridedDeviceAddressRegionKHR* miss, const VkStridedDeviceAddressRegionKHR* hit,
    const VkStridedDeviceAddressRegionKHR* callable, uint32_t width, uint32_t height, uint32_t depth)
{
    note(commands, { .kind = RecordedCommand::trace });
    VKPT_NEXT(commands, vkCmdTraceRaysKHR)(commands, generation, miss, hit, callable, width, height, depth);
}

VKAPI_ATTR void VKAPI_CALL build_structures(VkCommandBuffer commands, uint32_t count,
    const VkAccelerationStructureBuildGeometryInfoKHR* infos,
    const VkAccelerationStructureBuildRangeInfoKHR* const* ranges)
{
    note(commands, { .kind = RecordedCommand::build });
    VKPT_NEXT(commands, vkCmdBuildAccelerationStructuresKHR)(commands, count, infos, ranges);
}

VKAPI_ATTR void VKAPI_CALL fill_buffer(
    VkCommandBuffer commands, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size, uint32_t data)
{
    note(commands, { .kind = RecordedCommand::fill });
    VKPT_NEXT(commands, vkCmdFillBuffer)(commands, buffer, offset, size, data);
}

VKAPI_ATTR void VKAPI_CALL copy_buffer(
    VkCommandBuffer commands, VkBuffer from, VkBuffer to, uint32_t count, const VkBufferCopy* regions)
{
    note(commands, { .kind = RecordedCommand::copy });
    VKPT_NEXT(commands, vkCmdCopyBuffer)(commands, from, to, count, regions);
}

VKAPI_ATTR void VKAPI_CALL begin_label(VkCommandBuffer commands, const VkDebugUtilsLabelEXT* label)
{
    const std::lock_guard lock(mutex);
    labels[commands] = label->pLabelName;
}

VKAPI_ATTR void VKAPI_CALL end_label(VkCommandBuffer commands)
{
    const std::lock_guard lock(mutex);
    labels.erase(commands);
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
    const VkAllocationCallbacks* callbacks, VkDevice* device);
VKAPI_ATTR VkResult VKAPI_CALL create_instance(
    const VkInstanceCreateInfo* info, const VkAllocationCallbacks* callbacks, VkInstance* instance);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_function(VkInstance instance, const char* name);

// The layer's own; nullptr: there is none of that name.
PFN_vkVoidFunction find_function(const char* name)
{
    const std::pair<const char*, PFN_vkVoidFunction> functions[] = {
        { "vkGetInstanceProcAddr", PFN_vkVoidFunction(get_instance_function) },
        { "vkGetDeviceProcAddr", PFN_vkVoidFunction(get_device_function) },
        { "vkCreateInstance", PFN_vkVoidFunction(create_instance) },
        { "vkCreateDevice", PFN_vkVoidFunction(create_device) },
        { "vkBeginCommandBuffer", PFN_vkVoidFunction(begin_commands) },
        { "vkQueueSubmit", PFN_vkVoidFunction(submit) },
        { "vkCmdPipelineBarrier", PFN_vkVoidFunction(pipeline_barrier) },
        { "vkCmdDispatch", PFN_vkVoidFunction(dispatch) },
        { "vkCmdTraceRaysKHR", PFN_vkVoidFunction(trace_rays) },
        { "vkCmdBuildAccelerationStructuresKHR", PFN_vkVoidFunction(build_structures) },
        { "vkCmdFillBuffer", PFN_vkVoidFunction(fill_buffer) },
        { "vkCmdCopyBuffer", PFN_vkVoidFunction(copy_buffer) },
        { "vkCmdBeginDebugUtilsLabelEXT", PFN_vkVoidFunction(begin_label) },
        { "vkCmdEndDebugUtilsLabelEXT", PFN_vkVoidFunction(end_label) },
    };
    for (const auto& [known, function] : functions)
        if (std::strcmp(name, known) == 0)
            return function;
    return nullptr;
}

PFN_vkVoidFunction get_device_function(VkDevice device, const char* name)
{
    const std::lock_guard lock(mutex);
    const PFN_vkVoidFunction found = devices.at(key_of(device)).get_function(device, name), own = find_function(name);
    const bool is_label = own == PFN_vkVoidFunction(begin_label) || own == PFN_vkVoidFunction(end_label);
    return own && (found || is_label) ? own : found; // what the driver lacks stays missing
}

PFN_vkVoidFunction get_instance_function(VkInstance instance, const char* name)
{
    if (const PFN_vkVoidFunction own = find_function(name))
        return own;
    if (!instance)
        return nullptr;
    const std::lock_guard lock(mutex);
    return instances.at(key_of(instance))(instance, name);
}

// The loader's list of layers, in what it hands to vkCreateInstance and vkCreateDevice.
template <class LayerInfo, class Info> LayerInfo* find_link(const Info* info, VkStructureType type)
{
    for (auto* link = static_cast<const LayerInfo*>(info->pNext); link;
         link = static_cast<const LayerInfo*>(link->pNext))
        if (link->sType == type && link->function == VK_LAYER_LINK_INFO)
            return const_cast<LayerInfo*>(link);
    return nullptr;
}

VkResult create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* callbacks, VkInstance* instance)
{
    auto* link = find_link<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (!link)
        return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult result = PFN_vkCreateInstance(next(VK_NULL_HANDLE, "vkCreateInstance"))(info, callbacks, instance);
    const std::lock_guard lock(mutex);
    if (result == VK_SUCCESS)
        instances[key_of(*instance)] = next;
    return result;
}

VkResult create_device(
    VkPhysicalDevice physical, const VkDeviceCreateInfo* info, const VkAllocationCallbacks* callbacks, VkDevice* device)
{
    auto* link = find_link<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (!link)
        return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr next_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult result
        = PFN_vkCreateDevice(next_instance(VK_NULL_HANDLE, "vkCreateDevice"))(physical, info, callbacks, device);
    const std::lock_guard lock(mutex);
    if (result == VK_SUCCESS) {
        devices[key_of(*device)] = { *device, next };
        if (!recorded_device)
            recorded_device = key_of(*device);
    }
    return result;
}

} // namespace
} // namespace vkpt::tests

extern "C" __attribute__((visibility("default"))) VkResult vkNegotiateLoaderLayerInterfaceVersion(
    VkNegotiateLayerInterface* interface)
{
    interface->loaderLayerInterfaceVersion = 2;
    interface->pfnGetInstanceProcAddr = vkpt::tests::get_instance_function;
    interface->pfnGetDeviceProcAddr = vkpt::tests::get_device_function;
    interface->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}

extern "C" __attribute__((visibility("default"))) void vkpt_take_recorded_commands(
    std::vector<vkpt::tests::RecordedCommands>& submitted)
{
    const std::lock_guard lock(vkpt::tests::mutex);
    submitted = std::exchange(vkpt::tests::submitted, {});
}
