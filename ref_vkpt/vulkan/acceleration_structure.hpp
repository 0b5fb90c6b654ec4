// SPDX-License-Identifier: GPL-2.0-or-later
// One acceleration structure of the driver, with its memory. Destroying it demands that the device no longer uses it.
#pragma once

#include "ref_vkpt/vulkan/resources.hpp"

namespace vkpt {

class AccelerationStructure {
public:
    AccelerationStructure() = default;
    // Not built yet. `bytes`: from vkGetAccelerationStructureBuildSizesKHR.
    AccelerationStructure(
        const Gpu& gpu, VkAccelerationStructureTypeKHR type, VkDeviceSize bytes, std::string_view name);
    AccelerationStructure(AccelerationStructure&& other) noexcept { swap(other); }
    AccelerationStructure& operator=(AccelerationStructure other) noexcept
    {
        swap(other);
        return *this;
    }
    void swap(AccelerationStructure& other) noexcept;

    VkAccelerationStructureKHR handle() const { return handle_; }
    VkDeviceAddress address() const { return address_; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

private:
    VkDeviceAddress address_ = 0;
    Buffer memory_;
    Handle<VkAccelerationStructureKHR, vkDestroyAccelerationStructureKHR> handle_;
};

} // namespace vkpt
