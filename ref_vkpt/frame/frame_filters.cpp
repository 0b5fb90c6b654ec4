// SPDX-License-Identifier: GPL-2.0-or-later
// The part of the frame that works across frames: the denoiser and its history. docs/denoiser.md explains the passes.
#include "ref_vkpt/frame/denoiser.hpp"
#include "ref_vkpt/frame/frame.hpp"
#include "ref_vkpt/frame/frame_flags.hpp"

#include <algorithm>

namespace vkpt {

namespace {

// Halton's sequence (radical inverse of index + 1).
float halton(uint32_t index, uint32_t base)
{
    float value = 0, digit = 1;
    for (uint32_t rest = index + 1; rest > 0; rest /= base) {
        digit /= float(base);
        value += digit * float(rest % base);
    }
    return value;
}

// Fewer rendered pixels have more places each, so that all pixels of the result get their samples.
glm::vec2 offset_in_pixel(uint32_t index, glm::uvec2 rendered, glm::uvec2 resolved)
{
    const uint64_t pixels = std::max<uint64_t>(1, uint64_t(rendered.x) * rendered.y);
    constexpr uint64_t least = shared::OFFSETS_PER_PIXEL, most = 16 * least;
    const uint64_t places = least * resolved.x * resolved.y / pixels;
    index = uint32_t(index % std::clamp(places, least, most));
    return { halton(index, 2), halton(index, 3) };
}

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
void Frame::begin_filters(
    shared::FrameUniforms& uniforms, const SceneSnapshot& scene, const GpuWorld* gpu_world, bool average)
{
    if (!scene.world)
        return;
    const uint32_t flags = filter_flags();
    const bool antialiases = flags & shared::FRAME_ANTIALIASED;
    if (average || flags == 0) {
        state_.history.forget();
        return;
    }
    if (flags & shared::FRAME_DENOISED)
        uniforms.bounce_block = choose_bounce_block(graphics_.device);
    if (cvars::values().flt_taa == "upscale")
        uniforms.resolved_size = uniforms.output_size;
    if (antialiases) {
        uniforms.offset_phase = state_.offset_index % shared::OFFSETS_PER_PIXEL;
        uniforms.pixel_offset = offset_in_pixel(state_.offset_index++, uniforms.size, uniforms.resolved_size);
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
    const ViewHistory::Key& last = state_.history.continues_into(key) ? state_.history.last() : key;
    uniforms.flags |= &last != &key ? shared::FRAME_HISTORY : 0;
    uniforms.previous_camera = last.camera;
    uniforms.previous_size = last.size;
    uniforms.previous_scale = glm::vec2(last.size) / glm::vec2(key.size);
    uniforms.offset_change = last.pixel_offset - 0.5f - (key.pixel_offset - 0.5f) * uniforms.previous_scale;
    state_.history.keep(key);
    graphics_.screen.exchange_history();
    uniforms.screen = graphics_.screen.rows();
}

} // namespace vkpt
