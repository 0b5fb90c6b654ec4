// SPDX-License-Identifier: GPL-2.0-or-later
// The part of the frame that works across frames: the denoiser and its history. docs/denoiser.md explains the passes.
#include "ref_vkpt/frame/antialiasing.hpp"
#include "ref_vkpt/frame/denoiser.hpp"
#include "ref_vkpt/frame/frame.hpp"
#include "ref_vkpt/frame/frame_flags.hpp"

#include <algorithm>

namespace vkpt {

namespace {

// Whether anything is seen through something that is lit itself: glass, water, translucent models.
bool has_layers(const SceneSnapshot& scene)
{
    return std::ranges::any_of(scene.materials, [](const shared::Material& material) {
        return (material.flags & (shared::MATERIAL_TRANSLUCENT | shared::MATERIAL_FULLBRIGHT))
            == shared::MATERIAL_TRANSLUCENT;
    });
}

} // namespace

// Fills what the filters' passes ask of the uniforms. An averaged view, and one without a world, stays as it is
// sampled.
void Frame::begin_filters(shared::FrameUniforms& uniforms, View& view, const SceneSnapshot& scene,
    const GpuWorld* gpu_world, bool average) const
{
    if (!scene.world)
        return;
    const uint32_t flags = filter_flags();
    const bool antialiases = flags & shared::FRAME_ANTIALIASED;
    if (average || flags == 0) {
        view.history.forget();
        return;
    }
    if (flags & shared::FRAME_DENOISED)
        uniforms.bounce_block = choose_bounce_block(graphics_.device);
    if (cvars::values().flt_taa == "upscale")
        uniforms.resolved_size = uniforms.output_size;
    if (antialiases) {
        uniforms.offset_phase = view.offset_index % shared::OFFSETS_PER_PIXEL;
        uniforms.pixel_offset = offset_in_pixel(view.offset_index++, uniforms.size, uniforms.resolved_size);
    }
    uniforms.flags |= flags | (has_layers(scene) ? shared::FRAME_LAYERED : 0);
    ViewHistory::Key key;
    key.camera = uniforms.camera;
    key.pixel_offset = uniforms.pixel_offset;
    key.size = uniforms.size;
    key.output_size = uniforms.output_size;
    key.resolved_size = uniforms.resolved_size;
    key.world = gpu_world ? gpu_world->version : 0;
    key.time = scene.time;
    key.denoiser = uniforms.cvars.flt_denoiser;
    key.antialiases = antialiases;
    const ViewHistory::Key& last = view.history.continues_into(key) ? view.history.last() : key;
    uniforms.flags |= &last != &key ? shared::FRAME_HISTORY : 0;
    uniforms.previous_camera = last.camera;
    uniforms.previous_size = last.size;
    uniforms.previous_scale = glm::vec2(last.size) / glm::vec2(key.size);
    uniforms.offset_change = last.pixel_offset - 0.5f - (key.pixel_offset - 0.5f) * uniforms.previous_scale;
    view.history.keep(key);
    view.buffers.exchange_history();
    uniforms.screen = view.buffers.rows();
}

} // namespace vkpt
