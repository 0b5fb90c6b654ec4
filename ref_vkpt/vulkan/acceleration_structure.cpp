// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/acceleration_structure.hpp"

#include <utility>

namespace vkpt {

AccelerationStructure::AccelerationStructure(
    const Gpu& gpu, VkAccelerationStructureTypeKHR type, VkDeviceSize bytes, std::string_view name)
    : memory_(gpu, bytes, BufferHome::device, MemoryKind::acceleration, name)
{
    const VkDevice device = gpu.device.handle;
    VkAccelerationStructureCreateInfoKHR info { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR };
    info.buffer = memory_.handle();
    info.size = bytes;
    info.type = type;
    VKPT_RENEW(handle_, vkCreateAccelerationStructureKHR, device, info);
    VkAccelerationStructureDeviceAddressInfoKHR address {
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR
    };
    address.accelerationStructure = handle_;
    address_ = vkGetAccelerationStructureDeviceAddressKHR(device, &address);
    gpu.device.name_object(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, reinterpret_cast<uint64_t>(handle()), name);
}

void AccelerationStructure::swap(AccelerationStructure& other) noexcept
{
    std::swap(address_, other.address_);
    memory_.swap(other.memory_);
    handle_.swap(other.handle_);
}

} // namespace vkpt
