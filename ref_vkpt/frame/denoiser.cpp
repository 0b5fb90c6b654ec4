// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/denoiser.hpp"

#include "ref_vkpt/cvars.hpp"

#include <utility>

namespace vkpt {

namespace {

// To the first tap of each level of the spatial filter but the first: pixels.
const glm::ivec2 spread_ways[] = { { 2, 1 }, { -1, 5 }, { 8, 6 }, { -12, 16 } };
// Of the gradient's; odd, so that the result lies in gradient_b.
constexpr uint32_t gradient_levels = 3;

PassStep make_spread_step(const shared::FrameUniforms& uniforms, const shared::ScreenBuffer& source,
    const shared::ScreenBuffer& target, glm::ivec2 way)
{
    return make_step(shared::AtrousPush { source, target, way }, PassWork { uniforms.size });
}

} // namespace

glm::uvec2 choose_bounce_block(const Device& device)
{
    const std::string& pixels = cvars::values().pt_bounce_pixels;
    if (cvars::values().pt_bounces == 0 || pixels == "all")
        return glm::uvec2(1); // without bounces there is next to nothing to share
    if (pixels == "auto")
        return { 2, device.traits.bounce_block_rows };
    return { 2, pixels == "quarter" ? 2 : 1 };
}

PassWork stratum_work(const shared::FrameUniforms& uniforms)
{
    return { count_blocks(uniforms.size, uniforms.bounce_block * shared::STRATUM_BLOCKS) };
}

std::vector<PassStep> gradient_filter_steps(const shared::FrameUniforms& uniforms)
{
    shared::ScreenBuffer source = uniforms.screen.gradient_a, target = uniforms.screen.gradient_b;
    std::vector<PassStep> steps;
    for (uint32_t level = 0; level < gradient_levels; level++) {
        steps.push_back(
            make_step(shared::GradientFilterPush { source, target, 1u << level, level }, stratum_work(uniforms)));
        std::swap(source, target);
    }
    return steps;
}

std::vector<PassStep> spread_first_steps(const shared::FrameUniforms& uniforms)
{
    return { make_spread_step(uniforms, uniforms.screen.filter_b, uniforms.screen.filter_a, spread_ways[0]) };
}

std::vector<PassStep> spread_steps(const shared::FrameUniforms& uniforms)
{
    const shared::ScreenBuffers& screen = uniforms.screen;
    return { make_spread_step(uniforms, screen.filter_a, screen.filter_b, spread_ways[1]),
        make_spread_step(uniforms, screen.filter_b, screen.filter_a, spread_ways[2]) };
}

std::vector<PassStep> accumulate_steps(const shared::FrameUniforms& uniforms)
{
    return { make_spread_step(uniforms, uniforms.screen.filter_a, {}, spread_ways[3]) };
}

} // namespace vkpt
