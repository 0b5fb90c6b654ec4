// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/tree_tables.hpp"

#include "ref_vkpt/engine/errors.hpp"
#include "ref_vkpt/trace/wide_tree.hpp"
#include "shaders/shared/trace.h"

namespace vkpt {

TreeTables::TreeTables(const Gpu& gpu, const Bindings& bindings)
    : gpu_(gpu)
    , nodes_(gpu, MemoryKind::acceleration, "BVH nodes")
    , triangles_(gpu, MemoryKind::acceleration, "BVH triangles")
{
    const VkDescriptorPoolSize size { VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
        uint32_t(slots_.size() * slots_[0].views.size()) };
    VkDescriptorPoolCreateInfo pool { VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO };
    pool.maxSets = uint32_t(slots_.size());
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    VKPT_CHECK(vkCreateDescriptorPool(gpu.device.handle, &pool, nullptr, &pool_));
    const VkDescriptorSetLayout layout = bindings.tree_layout();
    for (uint32_t slot = 0; slot < slots_.size(); slot++) {
        VkDescriptorSetAllocateInfo info { VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO };
        info.descriptorPool = pool_;
        info.descriptorSetCount = 1;
        info.pSetLayouts = &layout;
        VKPT_CHECK(vkAllocateDescriptorSets(gpu.device.handle, &info, &slots_[slot].set));
        reserve(slot, nullptr, 0, 0, 0);
    }
}

TreeTables::~TreeTables()
{
    for (const Slot& slot : slots_)
        for (const VkBufferView view : slot.views)
            vkDestroyBufferView(gpu_.device.handle, view, nullptr);
    vkDestroyDescriptorPool(gpu_.device.handle, pool_, nullptr);
}

TreeTables::Room TreeTables::reserve(
    uint32_t frame_slot, const Bvh* world, uint64_t version, size_t nodes, size_t triangles)
{
    static const std::vector<uint32_t> nothing;
    const Room room { nodes_.reserve(frame_slot, world ? world->nodes : nothing, version, nodes * bvh_node_words),
        triangles_.reserve(frame_slot, world ? world->triangles : nothing, version, triangles * bvh_triangle_words) };
    bind(frame_slot);
    return room;
}

// Anew each time: the buffers may have grown, and a view costs nothing on the drivers that read it.
void TreeTables::bind(uint32_t frame_slot)
{
    Slot& slot = slots_[frame_slot];
    const Buffer* buffers[] = { &nodes_.buffer(frame_slot), &triangles_.buffer(frame_slot) };
    for (uint32_t binding = 0; binding < slot.views.size(); binding++) {
        vkDestroyBufferView(gpu_.device.handle, slot.views[binding], nullptr);
        VkBufferViewCreateInfo view { VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO };
        view.buffer = buffers[binding]->handle();
        view.format = VK_FORMAT_R32G32B32A32_UINT;
        view.range = buffers[binding]->size() / shared::BVH_TEXEL_BYTES * shared::BVH_TEXEL_BYTES;
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
