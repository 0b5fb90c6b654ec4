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
    pool_ = make_descriptor_pool(gpu.device.handle, 0, uint32_t(slots_.size()), std::span(&size, 1));
    for (uint32_t slot = 0; slot < slots_.size(); slot++) {
        slots_[slot].set = make_descriptor_set(gpu.device.handle, pool_, bindings.texel_layout());
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
        vkDestroyBufferView(gpu_.device.handle, slot.views[binding], nullptr);
        slot.views[binding] = VK_NULL_HANDLE;
        const bool single_words = binding == shared::TEXELS_STATIC_LIGHTS;
        const VkDeviceSize bytes = single_words ? sizeof(uint32_t) : shared::TEXEL_BYTES;
        const bool is_empty = !tables[binding] || tables[binding]->size() < bytes;
        const Buffer& buffer = is_empty ? empty_ : *tables[binding];
        VkBufferViewCreateInfo view { VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO };
        view.buffer = buffer.handle();
        view.format = single_words ? VK_FORMAT_R32_UINT : VK_FORMAT_R32G32B32A32_UINT;
        view.range = buffer.size() / bytes * bytes;
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
