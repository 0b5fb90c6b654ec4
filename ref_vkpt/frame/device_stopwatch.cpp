// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/device_stopwatch.hpp"

namespace vkpt {

void DeviceStopwatch::begin(VkCommandBuffer commands) const
{
    vkCmdResetQueryPool(commands, pool_, 0, 2);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool_, 0);
}

void DeviceStopwatch::end(VkCommandBuffer commands) const
{
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool_, 1);
}

double DeviceStopwatch::seconds() const
{
    uint64_t stamps[2] {};
    const VkResult result = vkGetQueryPoolResults(
        device_.handle, pool_, 0, 2, sizeof stamps, stamps, sizeof stamps[0], VK_QUERY_RESULT_64_BIT);
    return result == VK_SUCCESS ? device_.nanoseconds_between(stamps[0], stamps[1]) * 1e-9 : 0;
}

} // namespace vkpt
