// SPDX-License-Identifier: GPL-2.0-or-later
// Command buffers, and the pools that they and timestamps come from.
#pragma once

#include "ref_vkpt/vulkan/device.hpp"
#include "ref_vkpt/vulkan/handle.hpp"

namespace vkpt {

CommandPool make_command_pool(const Device& device, uint32_t queue_family);
QueryPool make_timestamp_pool(const Device& device, uint32_t count);
// Lives as long as the pool.
VkCommandBuffer make_command_buffer(const Device& device, VkCommandPool pool);
// Starts recording what is submitted once.
void begin_commands(VkCommandBuffer commands);
// Ends recording and submits; `done`, if any, is signalled then, and no fence.
void submit_commands(VkQueue queue, VkCommandBuffer commands, VkSemaphore done = VK_NULL_HANDLE);

} // namespace vkpt
