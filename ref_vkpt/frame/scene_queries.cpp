// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/scene_queries.hpp"

#include "ref_vkpt/frame/device_stopwatch.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>
#include <vector>

namespace vkpt {

namespace {

// Random numbers that a light's probability is averaged over: samplers whose probability depends on them spread widely.
constexpr uint32_t probability_draws = 64;
constexpr uint32_t counted_choices = 16384;
constexpr uint32_t max_groups = 64;

// Rows of so many, for one pixel each.
Viewpoint make_rows(size_t count, uint32_t row)
{
    Viewpoint from;
    from.size = { row, (uint32_t(count) + row - 1) / row };
    return from;
}

} // namespace

void SceneQueries::measure_irradiance(std::span<const IrradianceProbe> probes, uint32_t samples, float* rgb) const
{
    constexpr uint32_t row = 1024;
    const Viewpoint from = make_rows(probes.size(), std::min<uint32_t>(row, uint32_t(probes.size())));
    graphics.finish();
    frame.reserve(view, from.size);
    view.history.forget();
    view.radiance_size = from.size;
    view.radiance = &view.buffers.buffer_of(view.buffers.rows().accumulated);
    for (uint32_t sample = 0; sample < samples; sample++) {
        view.accumulated_frames = sample;
        graphics.run_once([&](VkCommandBuffer commands) {
            shared::FrameUniforms uniforms = frame.begin_query(commands, view, from, *view.snapshot, gpu_world);
            uniforms.frame_index = sample;
            uniforms.probes = frame.uploads().push(std::as_bytes(probes));
            uniforms.probe_count = uint32_t(probes.size());
            uniforms.flags = (uniforms.flags & shared::FRAME_ALPHA_TEST) | shared::FRAME_PROBES;
            frame.bind(commands, view, frame.write_uniforms(uniforms));
            frame.record_passes(uniforms);
        });
    }
    std::vector<float> image(size_t(from.size.x) * from.size.y * 3);
    frame.read_radiance(view, image.data());
    std::copy_n(image.data(), probes.size() * 3, rgb);
    view.accumulated_frames = 0;
}

uint32_t SceneQueries::rays_at_once() const
{
    constexpr uint32_t least = 1u << 18, most = 1u << 20;
    const VkExtent2D window = graphics.size();
    return std::clamp(window.width * window.height, least, most);
}

double SceneQueries::trace_rays(std::span<const TracedRay> rays, const TraceRequest& request, TracedHit* hits) const
{
    const uint32_t pixels_at_once = rays_at_once();
    const uint32_t row = std::clamp(request.row_length, 1u, pixels_at_once);
    const size_t chunk = size_t(pixels_at_once / row) * row;
    double seconds = 0;
    for (size_t first = 0; first < rays.size(); first += chunk)
        trace_chunk(rays.subspan(first, std::min(chunk, rays.size() - first)), row, request, hits + first, seconds);
    view.accumulated_frames = 0;
    return seconds / std::max(request.rounds, 1u);
}

void SceneQueries::trace_chunk(
    std::span<const TracedRay> rays, uint32_t row, const TraceRequest& request, TracedHit* hits, double& seconds) const
{
    const Buffer result(
        graphics.gpu, rays.size() * sizeof(TracedHit), BufferHome::readback, MemoryKind::staging, "traced hits");
    const Viewpoint from = make_rows(rays.size(), row);
    graphics.finish();
    frame.reserve(view, from.size);
    view.history.forget();
    uint32_t offset = 0;
    graphics.run_once([&](VkCommandBuffer commands) {
        shared::FrameUniforms uniforms = frame.begin_query(commands, view, from, *view.snapshot, gpu_world);
        uniforms.probes = frame.uploads().push(std::as_bytes(rays));
        uniforms.probe_count = uint32_t(rays.size());
        uniforms.probe_hits = result.address();
        uniforms.probe_mask = request.ray_mask;
        uniforms.flags
            = (uniforms.flags & shared::FRAME_ALPHA_TEST) | (request.visibility ? shared::FRAME_PROBE_VISIBILITY : 0);
        offset = frame.write_uniforms(uniforms);
    });
    std::optional<DeviceStopwatch> stopwatch;
    if (graphics.device.traits.has_distant_clock && graphics.device.timestamp_bits > 0)
        stopwatch.emplace(graphics.device);
    const auto run = [&](uint32_t rounds) {
        graphics.run_once([&](VkCommandBuffer commands) {
            frame.bind(commands, view, offset);
            if (stopwatch)
                stopwatch->begin(commands);
            for (uint32_t round = 0; round < rounds; round++)
                frame.recorder().record(find_pass(PassId::probe_rays), { PassWork { from.size }, 0, {} });
            if (stopwatch)
                stopwatch->end(commands);
            record_memory_barrier(commands, graphics.device.shader_stages(), VK_ACCESS_SHADER_WRITE_BIT,
                VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
        });
    };
    if (request.rounds > 1) // drivers compile at the first dispatch
        run(1);
    const auto start = std::chrono::steady_clock::now();
    run(std::max(request.rounds, 1u));
    seconds += stopwatch ? stopwatch->seconds()
                         : std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::memcpy(static_cast<void*>(hits), result.mapped(), rays.size() * sizeof(TracedHit));
}

bool SceneQueries::inspect_pixel(glm::uvec2 pixel, InspectedSurface& surface, std::span<InspectedLight> lights) const
{
    const glm::ivec2 inside = glm::ivec2(pixel) - view.viewpoint.origin;
    const glm::uvec2 shown = view.viewpoint.size, rendered = view.rendered_size;
    if (rendered.x == 0 || inside.x < 0 || inside.y < 0 || uint32_t(inside.x) >= shown.x
        || uint32_t(inside.y) >= shown.y)
        return false;
    const glm::uvec2 place = glm::min(glm::uvec2(inside) * rendered / shown, rendered - 1u);
    graphics.finish();
    const Buffer surface_buffer(
        graphics.gpu, sizeof surface, BufferHome::readback, MemoryKind::staging, "inspected surface");
    const Buffer light_buffer(
        graphics.gpu, lights.size_bytes(), BufferHome::readback, MemoryKind::staging, "inspected lights");
    std::memset(light_buffer.mapped(), 0, lights.size_bytes());
    Viewpoint from = view.viewpoint;
    from.size = rendered;
    graphics.run_once([&](VkCommandBuffer commands) {
        const shared::FrameUniforms uniforms = frame.begin_query(commands, view, from, *view.snapshot, gpu_world);
        frame.bind(commands, view, frame.write_uniforms(uniforms));
        const shared::InspectPush push { surface_buffer.address(), light_buffer.address(),
            place.y * rendered.x + place.x, uint32_t(lights.size()), probability_draws, counted_choices };
        const uint32_t groups = (uint32_t(lights.size()) + shared::PIXEL_GROUP_SIZE - 1) / shared::PIXEL_GROUP_SIZE;
        frame.recorder().record(
            find_pass(PassId::inspect_pixel), make_step(push, { {}, std::clamp(groups, 1u, max_groups) }));
        record_memory_barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
            VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    });
    std::memcpy(static_cast<void*>(&surface), surface_buffer.mapped(), sizeof surface);
    std::memcpy(static_cast<void*>(lights.data()), light_buffer.mapped(), lights.size_bytes());
    return true;
}

} // namespace vkpt
