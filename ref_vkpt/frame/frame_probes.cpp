// SPDX-License-Identifier: GPL-2.0-or-later
// What hosts ask of the scene beside pictures: irradiance at points, and rays.
#include "ref_vkpt/frame/frame.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace vkpt {

void Frame::measure_irradiance(std::span<const IrradianceProbe> probes, uint32_t samples, SceneSnapshot& scene,
    const GpuWorld& gpu_world, float* rgb)
{
    constexpr uint32_t row = 1024;
    View view;
    view.size = { std::min<uint32_t>(row, uint32_t(probes.size())), (uint32_t(probes.size()) + row - 1) / row };
    graphics_.finish();
    reserve(view.size);
    state_.history.forget();
    state_.size = view.size;
    state_.radiance = &graphics_.screen.accumulated();
    for (uint32_t sample = 0; sample < samples; sample++) {
        state_.accumulated_frames = sample;
        graphics_.run_once([&](VkCommandBuffer commands) {
            commands_ = commands;
            begin();
            shared::FrameUniforms uniforms = make_uniforms(view, view.size);
            fill_scene(uniforms.scene, scene, &gpu_world, Motion::unknown);
            uniforms.frame_index = sample;
            uniforms.probes = uploads_.push(std::as_bytes(probes));
            uniforms.probe_count = uint32_t(probes.size());
            uniforms.flags = shared::FRAME_PROBES | (scene.has_alpha_test ? shared::FRAME_ALPHA_TEST : 0);
            bind(write_uniforms(uniforms));
            graphics_.timer.begin_untimed(graphics_.slot());
            record_passes(uniforms);
        });
    }
    std::vector<float> picture(size_t(view.size.x) * view.size.y * 3);
    read_radiance(picture.data());
    std::copy_n(picture.data(), probes.size() * 3, rgb);
    restart_accumulation();
}

double Frame::trace_rays(std::span<const TracedRay> rays, const TraceRequest& request, SceneSnapshot& scene,
    const GpuWorld& gpu_world, TracedHit* hits)
{
    constexpr uint32_t pixels_at_once = 1u << 18; // screen buffers are made for as many
    const uint32_t row = std::clamp(request.row_length, 1u, pixels_at_once);
    const size_t chunk = size_t(pixels_at_once / row) * row;
    double seconds = 0;
    for (size_t first = 0; first < rays.size(); first += chunk)
        trace_chunk(rays.subspan(first, std::min(chunk, rays.size() - first)), row, request, scene, gpu_world,
            hits + first, seconds);
    restart_accumulation();
    return seconds / std::max(request.rounds, 1u);
}

void Frame::trace_chunk(std::span<const TracedRay> rays, uint32_t row, const TraceRequest& request,
    SceneSnapshot& scene, const GpuWorld& gpu_world, TracedHit* hits, double& seconds)
{
    const Buffer result(
        graphics_.gpu, rays.size() * sizeof(TracedHit), BufferHome::readback, MemoryKind::staging, "traced hits");
    View view;
    view.size = { row, (uint32_t(rays.size()) + row - 1) / row };
    graphics_.finish();
    reserve(view.size);
    state_.history.forget();
    uint32_t offset = 0;
    graphics_.run_once([&](VkCommandBuffer commands) {
        commands_ = commands;
        begin();
        shared::FrameUniforms uniforms = make_uniforms(view, view.size);
        fill_scene(uniforms.scene, scene, &gpu_world, Motion::unknown);
        uniforms.probes = uploads_.push(std::as_bytes(rays));
        uniforms.probe_count = uint32_t(rays.size());
        uniforms.probe_hits = result.address();
        uniforms.probe_mask = request.ray_mask;
        uniforms.flags = (request.visibility ? shared::FRAME_PROBE_VISIBILITY : 0)
            | (scene.has_alpha_test ? shared::FRAME_ALPHA_TEST : 0);
        offset = write_uniforms(uniforms);
    });
    const auto run = [&](uint32_t rounds) {
        graphics_.run_once([&](VkCommandBuffer commands) {
            commands_ = commands;
            graphics_.timer.begin_untimed(graphics_.slot());
            bind(offset);
            for (uint32_t round = 0; round < rounds; round++)
                recorder_.record(find_pass(PassId::probe_rays), { pixel_work(view.size), 0, {} });
            record_memory_barrier(commands, graphics_.device.shader_stages(), VK_ACCESS_SHADER_WRITE_BIT,
                VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
        });
    };
    if (request.rounds > 1) // drivers compile at the first dispatch
        run(1);
    const auto start = std::chrono::steady_clock::now();
    run(std::max(request.rounds, 1u));
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::memcpy(static_cast<void*>(hits), result.mapped(), rays.size() * sizeof(TracedHit));
}

} // namespace vkpt
