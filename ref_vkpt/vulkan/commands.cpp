// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/commands.hpp"

namespace vkpt {

CommandPool make_command_pool(const Device& device, uint32_t queue_family)
{
    VkCommandPoolCreateInfo info { VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO };
    info.queueFamilyIndex = queue_family;
    CommandPool pool;
    VKPT_RENEW(pool, vkCreateCommandPool, device.handle, info);
    return pool;
}

QueryPool make_timestamp_pool(const Device& device, uint32_t count)
{
    VkQueryPoolCreateInfo info { VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO };
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = count;
    QueryPool pool;
    VKPT_RENEW(pool, vkCreateQueryPool, device.handle, info);
    return pool;
}

VkCommandBuffer make_command_buffer(const Device& device, VkCommandPool pool)
{
    VkCommandBufferAllocateInfo info { VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO };
    info.commandPool = pool;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VKPT_CHECK(vkAllocateCommandBuffers(device.handle, &info, &commands));
    return commands;
}

void begin_commands(VkCommandBuffer commands)
{
    VkCommandBufferBeginInfo info { VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    VKPT_CHECK(vkBeginCommandBuffer(commands, &info));
}

void submit_commands(VkQueue queue, VkCommandBuffer commands, VkSemaphore done)
{
    VKPT_CHECK(vkEndCommandBuffer(commands));
    VkSubmitInfo info { VK_STRUCTURE_TYPE_SUBMIT_INFO };
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    info.signalSemaphoreCount = done ? 1 : 0;
    info.pSignalSemaphores = &done;
    VKPT_CHECK(vkQueueSubmit(queue, 1, &info, VK_NULL_HANDLE));
}

} // namespace vkpt
