// SPDX-License-Identifier: GPL-2.0-or-later
// The light cache of a map on the device, and who keeps it up to date: docs/light-cache.md.
#pragma once

#include "ref_vkpt/frame/pass_recorder.hpp"
#include "ref_vkpt/scene/world.hpp"
#include "ref_vkpt/vulkan/uploader.hpp"

#include <cstdint>

namespace vkpt {

struct View;
struct GpuWorld;
class Frame;
class Graphics;

// See LightCacheView.
struct GpuLightCache {
    Buffer faces, planes, cells, corners;
    Buffer values, lobes; // of either the first half is read by rays, the second updated
    Buffer guides, guide_blocks, guide_lists, guide_entries; // after LightCacheKeeper::fill
    uint32_t cell_count = 0, value_count = 0;

    shared::LightCacheView addresses() const;
};
// SAMPLER_NEEDS_* of the tables that the cache's own samples read, whichever sampler images use; 0: there is no
// cache.
uint32_t light_cache_needs();
GpuLightCache upload_light_cache(const LightCacheLayout& layout, Uploader& uploader);

class LightCacheKeeper {
public:
    // Whether frames ask for a cache that has no values yet.
    bool wants_filling(const GpuWorld& gpu_world) const;
    // Between frames, once for each map and after its first view: first values for every cell, and what stands out.
    void fill(Graphics& graphics, Frame& frame, View& view, GpuWorld& gpu_world);
    // Tells the shaders what to update in this frame, and what they may use. `average`: the image is averaged. Now
    // and then rays get the values that were updated since, which these commands copy.
    void begin_frame(
        VkCommandBuffer commands, shared::FrameUniforms& uniforms, const GpuWorld& gpu_world, bool average);
    // So many times rays have got new values: what they bring differs from before.
    uint32_t publications() const { return publications_; }

private:
    uint64_t world_ = 0; // GpuWorld::version of the map that it was filled for
    uint32_t next_cell_ = 0, rounds_ = 0;
    uint32_t frames_ = 0, publications_ = 0; // updates since the last publication
};

PassWork cache_update_work(const shared::FrameUniforms& uniforms);

} // namespace vkpt
