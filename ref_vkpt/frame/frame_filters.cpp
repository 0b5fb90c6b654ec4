// SPDX-License-Identifier: GPL-2.0-or-later
// The part of the frame that works across frames: the denoiser and its history. docs/denoiser.md explains the passes.
#include "ref_vkpt/frame/frame.hpp"

#include <iterator>
#include <utility>

namespace vkpt {

namespace {

// Levels of the spatial filter: taps 1, 2, 4 ... pixels apart.
constexpr uint32_t filter_levels = 5;
// Of the gradient's; odd, so that the result lies in gradient_b.
constexpr uint32_t gradient_levels = 3;

// Halton's sequence to the bases 2 and 3, its first eight points.
constexpr glm::vec2 offsets_in_pixel[]
    = { { 1 / 2.0f, 1 / 3.0f }, { 1 / 4.0f, 2 / 3.0f }, { 3 / 4.0f, 1 / 9.0f }, { 1 / 8.0f, 4 / 9.0f },
          { 5 / 8.0f, 7 / 9.0f }, { 3 / 8.0f, 2 / 9.0f }, { 7 / 8.0f, 5 / 9.0f }, { 1 / 16.0f, 8 / 9.0f } };

uint32_t stratum_groups(glm::uvec2 size)
{
    const uint32_t strata = (size.x + 2) / 3 * ((size.y + 2) / 3);
    return (strata + shared::PIXEL_GROUP_SIZE - 1) / shared::PIXEL_GROUP_SIZE;
}

} // namespace

// Fills what the filters' passes ask of the uniforms. An averaged view, and one without a world, stays as it is
// sampled.
void Frame::begin_filters(
    shared::FrameUniforms& uniforms, const SceneSnapshot& scene, const GpuWorld* gpu_world, bool average)
{
    const bool antialiases = cvars::values().flt_taa == "on",
               denoises = uniforms.cvars.flt_denoiser != shared::DENOISER_OFF;
    if (average || !scene.world || !(antialiases || denoises)) {
        history_.forget();
        return;
    }
    if (antialiases)
        uniforms.pixel_offset = offsets_in_pixel[offset_index_++ % std::size(offsets_in_pixel)];
    uniforms.flags |= shared::FRAME_REPROJECTED | (antialiases ? shared::FRAME_ANTIALIASED : 0)
        | (denoises ? shared::FRAME_DENOISED : 0)
        | (uniforms.cvars.flt_denoiser == shared::DENOISER_ASVGF ? shared::FRAME_REPLAYED : 0);
    ViewHistory::Key key;
    key.camera = uniforms.camera;
    key.pixel_offset = uniforms.pixel_offset;
    key.size = uniforms.size;
    key.world = gpu_world ? gpu_world->version : 0;
    key.time = scene.time;
    key.denoiser = uniforms.cvars.flt_denoiser;
    key.antialiases = antialiases;
    const ViewHistory::Key& last = history_.continues_into(key) ? history_.last() : key;
    uniforms.flags |= &last != &key ? shared::FRAME_HISTORY : 0;
    uniforms.previous_camera = last.camera;
    uniforms.offset_change = last.pixel_offset - key.pixel_offset;
    history_.keep(key);
    graphics_.screen.exchange_history();
    uniforms.screen = graphics_.screen.addresses();
}

void Frame::record_denoiser(const shared::FrameUniforms& uniforms)
{
    const uint32_t groups = pixel_groups(uniforms.size);
    if (uniforms.flags & shared::FRAME_REPLAYED)
        record_gradient(uniforms);
    record_pass("denoise_temporal", groups);
    if (uniforms.cvars.flt_denoiser != shared::DENOISER_TEMPORAL)
        record_spatial_filter(groups);
}

// Before the light passes.
void Frame::record_replay(const shared::FrameUniforms& uniforms)
{
    if ((uniforms.flags & shared::FRAME_REPLAYED) && (uniforms.flags & shared::FRAME_HISTORY))
        record_pass("replay_samples", stratum_groups(uniforms.size));
}

void Frame::record_gradient(const shared::FrameUniforms& uniforms)
{
    if (!(uniforms.flags & shared::FRAME_HISTORY))
        return;
    const shared::ScreenBuffers& screen = graphics_.screen.addresses();
    const uint32_t groups = stratum_groups(uniforms.size);
    record_pass("denoise_gradient", groups);
    uint64_t source = screen.gradient_a, target = screen.gradient_b;
    for (uint32_t level = 0; level < gradient_levels; level++) {
        record_filter_level("denoise_gradient_filter", { source, target, 1u << level, level }, groups);
        std::swap(source, target);
    }
}

void Frame::record_filter_level(const char* name, const shared::FilterPush& push, uint32_t groups)
{
    vkCmdPushConstants(commands_, graphics_.bindings.pipeline_layout(), VK_SHADER_STAGE_ALL, 0, sizeof(push), &push);
    record_pass(name, groups);
}

// The first level's result is what the next view accumulates on; the last one's lies in filter_b.
void Frame::record_spatial_filter(uint32_t groups)
{
    const shared::ScreenBuffers& screen = graphics_.screen.addresses();
    uint64_t source = screen.filter_a, target = screen.filtered;
    for (uint32_t level = 0; level < filter_levels; level++) {
        record_filter_level("denoise_filter", { source, target, 1u << level, level }, groups);
        source = target;
        target = (filter_levels - level) % 2 == 0 ? screen.filter_b : screen.filter_a;
    }
}

} // namespace vkpt
