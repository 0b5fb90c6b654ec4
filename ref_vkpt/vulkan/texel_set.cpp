// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/vulkan/texel_set.hpp"

#include "ref_vkpt/vulkan/bindings.hpp"

#include <span>

namespace vkpt {

TexelSet::TexelSet(const Gpu& gpu, VkDescriptorSetLayout layout, TexelShape shape, uint32_t count)
    : shape_(shape)
    , empty_(gpu, 0, BufferHome::device, MemoryKind::geometry, "empty table")
    , views_(count)
{
    const VkDescriptorPoolSize size { VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, count };
    pool_ = make_descriptor_pool(gpu.device.handle, 0, 1, std::span(&size, 1));
    set_ = make_descriptor_set(gpu.device.handle, pool_, layout);
    for (uint32_t number = 0; number < count; number++)
        bind(gpu, number, nullptr, 4);
}

void TexelSet::bind(const Gpu& gpu, uint32_t number, const Buffer* buffer, uint32_t words)
{
    views_[number] = TexelView(gpu, buffer ? *buffer : empty_, words);
    const VkBufferView view = views_[number].handle();
    VkWriteDescriptorSet write { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET };
    write.dstSet = set_;
    write.dstBinding = shape_ == TexelShape::bindings ? number : 0;
    write.dstArrayElement = shape_ == TexelShape::array ? number : 0;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    write.pTexelBufferView = &view;
    vkUpdateDescriptorSets(gpu.device.handle, 1, &write, 0, nullptr);
}

} // namespace vkpt
