// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/light_visibility.hpp"

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/frame/gpu_world.hpp"
#include "ref_vkpt/vulkan/shaders.hpp"
#include "shaders/shared/light_sampler.h"

#include <algorithm>
#include <bit>

namespace vkpt {

namespace {

// In a frame with new weights A-SVGF measures nothing. A map's first views learn fast: after a few frames with new
// weights each the intervals double.
constexpr uint32_t first_publications = 4, longest_interval = 16;

constexpr size_t row_bytes = sizeof(glm::uvec4), count_bytes = sizeof(uint32_t);

// Of a power of two of tiles of pixels one is counted.
uint32_t choose_counted_tiles(glm::uvec2 size, uint32_t frames)
{
    const uint64_t rays = uint64_t(size.x) * size.y * frames;
    return std::bit_ceil(uint32_t(rays / shared::VISIBILITY_MAX_RAYS) + 1) - 1;
}

} // namespace

Buffer make_light_visibility(Uploader& uploader)
{
    const std::vector<std::byte> zeros(
        size_t(shared::VISIBILITY_ROWS) * (row_bytes + shared::VISIBILITY_SLOTS * count_bytes));
    return uploader.make_buffer(zeros, MemoryKind::lights, "light visibility");
}

void LightVisibilityKeeper::begin_frame(shared::FrameUniforms& uniforms, const GpuWorld& gpu_world,
    std::string_view light_sampler, uint32_t static_emitters)
{
    if (publishes_)
        publications_++;
    publishes_ = false;
    const bool weighs = (find_light_sampler(light_sampler)->traits & shared::SAMPLER_WEIGHS_VISIBILITY) != 0;
    is_used_ = weighs && cvars::values().pt_light_visibility != 0 && (uniforms.flags & shared::FRAME_DENOISED) != 0;
    if (!is_used_)
        return;
    if (world_ != gpu_world.version) {
        world_ = gpu_world.version;
        frames_ = 0;
        interval_ = 1;
        made_ = 0;
        publications_++;
    }
    shared::LightVisibilityView& view = uniforms.scene.visibility;
    view.rows = gpu_world.light_visibility.address();
    view.counts = view.rows + shared::VISIBILITY_ROWS * row_bytes;
    view.counted_tiles = choose_counted_tiles(uniforms.size, interval_);
    view.static_emitters = static_emitters;
    if (++frames_ < interval_)
        return;
    uniforms.flags |= shared::FRAME_PUBLISH_VISIBILITY;
    publishes_ = true;
    frames_ = 0;
    if (++made_ >= first_publications)
        interval_ = std::min(2 * interval_, longest_interval);
}

} // namespace vkpt
