// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/acceleration_structure.hpp"

#include <utility>

namespace vkpt {

AccelerationStructure::AccelerationStructure(
    const Gpu& gpu, VkAccelerationStructureTypeKHR type, VkDeviceSize bytes, std::string_view name)
    : device_(gpu.device.handle)
    , memory_(gpu, bytes, BufferHome::device, MemoryKind::acceleration, name)
{
    VkAccelerationStructureCreateInfoKHR info { VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR };
    info.buffer = memory_.handle();
    info.size = bytes;
    info.type = type;
    VKPT_CHECK(vkCreateAccelerationStructureKHR(device_, &info, nullptr, &handle_));
    VkAccelerationStructureDeviceAddressInfoKHR address {
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR
    };
    address.accelerationStructure = handle_;
    address_ = vkGetAccelerationStructureDeviceAddressKHR(device_, &address);
    gpu.device.name_object(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, reinterpret_cast<uint64_t>(handle_), name);
}

AccelerationStructure::~AccelerationStructure()
{
    if (handle_)
        vkDestroyAccelerationStructureKHR(device_, handle_, nullptr);
}

void AccelerationStructure::swap(AccelerationStructure& other) noexcept
{
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    std::swap(address_, other.address_);
    std::swap(memory_, other.memory_);
}

} // namespace vkpt
