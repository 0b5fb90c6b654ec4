// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/scene_texels.hpp"

#include "ref_vkpt/engine/errors.hpp"

namespace vkpt {

SceneTexels::SceneTexels(const Gpu& gpu, const Bindings& bindings)
    : gpu_(gpu)
    , empty_(gpu, shared::TEXEL_BYTES, BufferHome::upload, MemoryKind::geometry, "empty table")
{
    const VkDescriptorPoolSize size { VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
        uint32_t(slots_.size() * shared::TEXELS_COUNT) };
    VkDescriptorPoolCreateInfo pool { VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO };
    pool.maxSets = uint32_t(slots_.size());
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    VKPT_CHECK(vkCreateDescriptorPool(gpu.device.handle, &pool, nullptr, &pool_));
    const VkDescriptorSetLayout layout = bindings.texel_layout();
    for (uint32_t slot = 0; slot < slots_.size(); slot++) {
        VkDescriptorSetAllocateInfo info { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO };
        info.descriptorPool = pool_;
        info.descriptorSetCount = 1;
        info.pSetLayouts = &layout;
        VKPT_CHECK(vkAllocateDescriptorSets(gpu.device.handle, &info, &slots_[slot].set));
        bind(slot, {});
    }
}

SceneTexels::~SceneTexels()
{
    for (const Slot& slot : slots_)
        for (const VkBufferView view : slot.views)
            vkDestroyBufferView(gpu_.device.handle, view, nullptr);
    vkDestroyDescriptorPool(gpu_.device.handle, pool_, nullptr);
}

// All views anew: any of the buffers may be another one, and on the drivers that read them views cost nothing.
void SceneTexels::bind(uint32_t frame_slot, const Tables& tables)
{
    Slot& slot = slots_[frame_slot];
    for (uint32_t binding = 0; binding < shared::TEXELS_COUNT; binding++) {
        const Buffer& buffer = tables[binding] ? *tables[binding] : empty_;
        vkDestroyBufferView(gpu_.device.handle, slot.views[binding], nullptr);
        slot.views[binding] = VK_NULL_HANDLE;
        VkBufferViewCreateInfo view { VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO };
        view.buffer = buffer.handle();
        view.format = VK_FORMAT_R32G32B32A32_UINT;
        view.range = buffer.size() / shared::TEXEL_BYTES * shared::TEXEL_BYTES;
        VKPT_CHECK(vkCreateBufferView(gpu_.device.handle, &view, nullptr, &slot.views[binding]));
        VkWriteDescriptorSet write { VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET };
        write.dstSet = slot.set;
        write.dstBinding = binding;
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
        write.pTexelBufferView = &slot.views[binding];
        vkUpdateDescriptorSets(gpu_.device.handle, 1, &write, 0, nullptr);
    }
}

} // namespace vkpt
