// SPDX-License-Identifier: GPL-2.0-or-later
// The light sampler asked about one pixel of the last view.
#include "ref_vkpt/frame/frame.hpp"

#include <algorithm>
#include <cstring>

namespace vkpt {

namespace {

// Random numbers that a light's probability is averaged over: samplers whose probability depends on them spread widely.
constexpr uint32_t probability_draws = 64;
constexpr uint32_t counted_choices = 16384;
constexpr uint32_t max_groups = 64;

} // namespace

bool Frame::inspect_pixel(glm::uvec2 pixel, SceneSnapshot& scene, const GpuWorld& gpu_world, InspectedSurface& surface,
    std::span<InspectedLight> lights)
{
    const glm::ivec2 inside = glm::ivec2(pixel) - state_.view.origin;
    if (state_.size.x == 0 || inside.x < 0 || inside.y < 0 || uint32_t(inside.x) >= state_.view.size.x
        || uint32_t(inside.y) >= state_.view.size.y)
        return false;
    const glm::uvec2 rendered = glm::min(glm::uvec2(inside) * state_.size / state_.view.size, state_.size - 1u);
    graphics_.finish();
    const Buffer surface_buffer(
        graphics_.gpu, sizeof surface, BufferHome::readback, MemoryKind::staging, "inspected surface");
    const Buffer light_buffer(
        graphics_.gpu, lights.size_bytes(), BufferHome::readback, MemoryKind::staging, "inspected lights");
    std::memset(light_buffer.mapped(), 0, lights.size_bytes());
    graphics_.run_once([&](VkCommandBuffer commands) {
        commands_ = commands;
        begin();
        shared::FrameUniforms uniforms = make_uniforms(state_.view, state_.size);
        fill_scene(uniforms.scene, scene, &gpu_world, Motion::unknown);
        bind(write_uniforms(uniforms));
        const shared::InspectPush push { surface_buffer.address(), light_buffer.address(),
            rendered.y * state_.size.x + rendered.x, uint32_t(lights.size()), probability_draws, counted_choices };
        const uint32_t groups = (uint32_t(lights.size()) + shared::PIXEL_GROUP_SIZE - 1) / shared::PIXEL_GROUP_SIZE;
        recorder_.record(
            find_pass(PassId::inspect_pixel), make_step(push, { std::clamp(groups, 1u, max_groups), { 0, 0 } }));
        record_memory_barrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
            VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    });
    std::memcpy(&surface, surface_buffer.mapped(), sizeof surface);
    std::memcpy(lights.data(), light_buffer.mapped(), lights.size_bytes());
    return true;
}

} // namespace vkpt
