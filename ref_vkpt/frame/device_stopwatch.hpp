// SPDX-License-Identifier: GPL-2.0-or-later
// The device's time for the commands between two points, by timestamps.
#pragma once

#include "ref_vkpt/vulkan/commands.hpp"

namespace vkpt {

class DeviceStopwatch {
public:
    // The device's queue has timestamps.
    explicit DeviceStopwatch(const Device& device)
        : device_(device)
    {
    }
    DeviceStopwatch(const DeviceStopwatch&) = delete;
    DeviceStopwatch& operator=(const DeviceStopwatch&) = delete;

    // Each once. What was recorded before the begin is not counted.
    void begin(VkCommandBuffer commands) const;
    void end(VkCommandBuffer commands) const;
    // After the commands have finished. 0: the device has told nothing.
    double seconds() const;

private:
    const Device& device_;
    QueryPool pool_ = make_timestamp_pool(device_, 2);
};

} // namespace vkpt
