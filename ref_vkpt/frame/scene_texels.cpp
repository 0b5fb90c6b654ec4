// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/scene_texels.hpp"

namespace vkpt {

SceneTexels::SceneTexels(const Gpu& gpu, const Bindings& bindings)
    : gpu_(gpu)
    , empty_(gpu, 0, BufferHome::upload, MemoryKind::geometry, "empty table")
{
    const VkDescriptorPoolSize size { VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
        uint32_t(slots_.size() * shared::TEXELS_COUNT) };
    pool_ = make_descriptor_pool(gpu.device.handle, 0, uint32_t(slots_.size()), std::span(&size, 1));
    for (uint32_t slot = 0; slot < slots_.size(); slot++) {
        slots_[slot].set = make_descriptor_set(gpu.device.handle, pool_, bindings.scene_layout());
        bind(slot, {});
    }
}

SceneTexels::~SceneTexels() { vkDestroyDescriptorPool(gpu_.device.handle, pool_, nullptr); }

// All views anew: any of the buffers may be another one, and on the drivers that read them views cost nothing.
void SceneTexels::bind(uint32_t frame_slot, const Tables& tables)
{
    Slot& slot = slots_[frame_slot];
    for (uint32_t binding = 0; binding < shared::TEXELS_COUNT; binding++) {
        const uint32_t words = binding == shared::TEXELS_STATIC_LIGHTS ? 1 : shared::TEXEL_BYTES / sizeof(uint32_t);
        slot.views[binding] = TexelView(gpu_, tables[binding] ? *tables[binding] : empty_, words);
        write_texels(gpu_.device.handle, slot.set, binding, 0, slot.views[binding]);
    }
}

} // namespace vkpt
