// SPDX-License-Identifier: GPL-2.0-or-later
// What a frame's pass is run over, by its row's extent.
#include "ref_vkpt/frame/bloom.hpp"
#include "ref_vkpt/frame/denoiser.hpp"
#include "ref_vkpt/frame/light_cache.hpp"

#include <cassert>

namespace vkpt {

namespace {

std::vector<PassStep> level_steps(PassId pass, const shared::FrameUniforms& uniforms)
{
    switch (pass) {
    case PassId::denoise_gradient_filter:
        return gradient_filter_steps(uniforms);
    case PassId::denoise_atrous_first:
        return spread_first_steps(uniforms);
    case PassId::denoise_atrous:
        return spread_steps(uniforms);
    case PassId::accumulate:
        return accumulate_steps(uniforms);
    case PassId::bloom_shrink:
        return bloom_shrink_steps(uniforms);
    case PassId::bloom_grow:
        return bloom_grow_steps(uniforms);
    default:
        assert(!"the pass's row says LEVELS, and nobody knows them");
        return {};
    }
}

PassWork work_over(PassExtent extent, const shared::FrameUniforms& uniforms)
{
    switch (extent) {
    case PassExtent::bounce_blocks:
        return { count_blocks(uniforms.size, uniforms.bounce_block) };
    case PassExtent::cache_cells:
        return cache_update_work(uniforms);
    case PassExtent::half:
        return { count_blocks(uniforms.size, glm::uvec2(2)) };
    case PassExtent::strata:
        return stratum_work(uniforms);
    case PassExtent::resolved:
        return { uniforms.resolved_size };
    case PassExtent::visibility_table:
        return { glm::uvec2(shared::VISIBILITY_GRID) };
    case PassExtent::output:
        return { uniforms.output_size };
    case PassExtent::one:
        return { { shared::PIXEL_GROUP_SIZE, 1 }, 1 };
    default:
        return { uniforms.size };
    }
}

} // namespace

std::vector<PassStep> pass_steps(const Pass& pass, const shared::FrameUniforms& uniforms)
{
    if (pass.extent == PassExtent::levels)
        return level_steps(pass.id, uniforms);
    return { PassStep { work_over(pass.extent, uniforms), 0, {} } };
}

} // namespace vkpt
