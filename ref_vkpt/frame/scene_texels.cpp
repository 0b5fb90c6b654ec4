// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/scene_texels.hpp"

namespace vkpt {

SceneTexels::SceneTexels(const Gpu& gpu, const Bindings& bindings)
    : gpu_(gpu)
{
    for (TexelSet& slot : slots_)
        slot = TexelSet(gpu, bindings.scene_layout(), TexelShape::bindings, shared::TEXELS_COUNT);
}

// All views anew: any of the buffers may be another one, and on the drivers that read them views cost nothing.
void SceneTexels::bind(uint32_t frame_slot, const Tables& tables)
{
    for (uint32_t binding = 0; binding < shared::TEXELS_COUNT; binding++) {
        const uint32_t words = binding == shared::TEXELS_STATIC_LIGHTS ? 1 : shared::TEXEL_BYTES / sizeof(uint32_t);
        slots_[frame_slot].bind(gpu_, binding, tables[binding], words);
    }
}

} // namespace vkpt
