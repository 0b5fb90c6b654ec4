// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/frame.hpp"

#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/frame/bloom.hpp"
#include "ref_vkpt/lights/ltc_table.hpp"
#include "ref_vkpt/noise/blue_noise.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <string>

namespace vkpt {

namespace {

// 3D views that one frame can hold; the engine draws one or two.
constexpr uint32_t max_views = 16;
// With a fixed pt_seed the numbers of a run do not depend on how long the game has been running.
constexpr float first_frame_seconds = 1.0f / 60;

constexpr size_t light_level_bytes = sizeof(float) * shared::LIGHT_LEVEL_LANES;
static_assert(shared::LIGHT_LEVEL_LANES == shared::PIXEL_GROUP_SIZE);

constexpr VkAccessFlags shader_access = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;

} // namespace

Frame::Frame(Graphics& graphics, Workers& workers)
    : graphics_(graphics)
    , recorder_(graphics)
    , uploads_(graphics.gpu, MemoryKind::staging)
    , moving_writer_(workers)
    , structures_(graphics.gpu)
{
    const VkDeviceSize alignment = graphics.device.properties.limits.minUniformBufferOffsetAlignment;
    uniform_stride_ = (sizeof(shared::FrameUniforms) + alignment - 1) / alignment * alignment;
    uniforms_ = Buffer(graphics.gpu, uniform_stride_ * max_views * frames_in_flight, BufferHome::upload,
        MemoryKind::staging, "frame uniforms");
    exposure_ = make_exposure();
    ltc_ = graphics.uploader.make_buffer(
        std::vector<float>(ltc_table.begin(), ltc_table.end()), MemoryKind::lights, "linearly transformed cosines");
    blue_noise_
        = graphics.uploader.make_buffer(std::as_bytes(std::span(blue_noise_words)), MemoryKind::images, "blue noise");
    readback_ = Buffer(
        graphics.gpu, light_level_bytes * frames_in_flight, BufferHome::readback, MemoryKind::staging, "light level");
    std::memset(readback_.mapped(), 0, readback_.size());
    ray_counts_
        = Buffer(graphics.gpu, sizeof(shared::RayCounts), BufferHome::device, MemoryKind::staging, "ray counts");
    read_ray_counts_ = Buffer(
        graphics.gpu, sizeof(shared::RayCounts), BufferHome::readback, MemoryKind::staging, "ray counts readback");
    std::memset(read_ray_counts_.mapped(), 0, read_ray_counts_.size());
    statistics_ = Buffer(graphics.gpu, sizeof(shared::FrameStatistics) * frames_in_flight, BufferHome::readback,
        MemoryKind::staging, "frame statistics");
    std::memset(statistics_.mapped(), 0, statistics_.size());
    graphics.bindings.bind_uniforms(uniforms_, sizeof(shared::FrameUniforms));
    graphics.uploader.flush();
}

void Frame::begin()
{
    views_this_frame_ = 0;
    uploads_.begin_frame(graphics_.slot());
    structures_.begin_frame(graphics_.slot());
    std::array<float, shared::LIGHT_LEVEL_LANES> lanes;
    std::memcpy(lanes.data(), readback_.mapped() + graphics_.slot() * light_level_bytes, light_level_bytes);
    light_level_ = std::accumulate(lanes.begin(), lanes.end(), 0.0f) / float(lanes.size());
    read_statistics();
    render_scale_.add_frame(graphics_.timer.frame_milliseconds(), scale_limits());
    // Room for the largest view now: once recording refers to the buffers, they cannot be replaced. For the whole
    // window, though fewer pixels may be rendered, so that a change of the render size costs nothing.
    const VkExtent2D output = graphics_.size();
    reserve({ output.width, output.height });
}

// Of the slot's last frame, which has finished.
void Frame::read_statistics()
{
    std::byte* const mapped = statistics_.mapped() + graphics_.slot() * sizeof(shared::FrameStatistics);
    shared::FrameStatistics statistics;
    std::memcpy(&statistics, mapped, sizeof(statistics));
    std::memset(mapped, 0, sizeof(statistics));
    if (statistics.broken_pixels > 0 && broken_pixels_ == 0)
        engine::print(
            "ref_vkpt: the light of {} pixels is not finite, they are shown black; pt_info counts them. Please "
            "report the map, the position and the settings",
            statistics.broken_pixels);
    broken_pixels_ += statistics.broken_pixels;
}

RenderScale::Limits Frame::scale_limits()
{
    constexpr uint32_t lowest = 50; // below it there are too few samples a pixel for upscaling to follow movement
    const CvarValues& cvars = cvars::values();
    return { cvars.pt_target_ms, lowest, uint32_t(cvars.pt_render_scale) };
}

glm::uvec2 Frame::scaled_size(glm::uvec2 size) const
{
    return glm::max(size * render_scale_.percent(scale_limits()) / 100u, glm::uvec2(1));
}

void Frame::reserve(glm::uvec2 size)
{
    if (!graphics_.screen.must_grow(size))
        return;
    graphics_.finish();
    graphics_.screen.reserve_pixels(size);
    state_.radiance = nullptr;
    restart_accumulation();
    state_.history.forget();
}

shared::FrameUniforms Frame::make_uniforms(const View& view, glm::uvec2 size)
{
    const CvarValues& cvars = cvars::values();
    const auto now = std::chrono::steady_clock::now();
    const float seconds = std::chrono::duration<float>(now - state_.time).count();
    state_.time = now;

    shared::FrameUniforms uniforms {};
    uniforms.camera = view.camera;
    uniforms.pixel_offset = glm::vec2(0.5f);
    uniforms.screen = graphics_.screen.rows();
    uniforms.exposure = exposure_.address();
    uniforms.statistics = statistics_.address() + graphics_.slot() * sizeof(shared::FrameStatistics);
    uniforms.ltc = ltc_.address();
    uniforms.blue_noise = blue_noise_.address();
    uniforms.ray_counts = ray_counts_.address();
    uniforms.light_level = readback_.address() + graphics_.slot() * light_level_bytes;
    uniforms.size = uniforms.resolved_size = uniforms.previous_size = size;
    uniforms.previous_scale = glm::vec2(1);
    uniforms.output_words = graphics_.screen.output().words.address();
    uniforms.output_across = graphics_.size().width;
    uniforms.output_origin = glm::uvec2(view.origin);
    uniforms.output_size = view.size;
    uniforms.frame_seconds = cvars.pt_seed > 0 ? first_frame_seconds : std::min(seconds, 1.0f);
    uniforms.seed = uint32_t(cvars.pt_seed);
    uniforms.frame_index = cvars.pt_seed > 0 ? state_.accumulated_frames : state_.noise_index++;
    uniforms.bounce_block = glm::uvec2(1);
    uniforms.accumulated_frames = state_.accumulated_frames;
    uniforms.blend = cvars.gl_polyblend != 0 ? view.blend : glm::vec4(0);
    uniforms.gamma = cvars.vid_gamma;
    uniforms.overbright = std::clamp(cvars.vk_overbrightbits, 0.0f, 100.0f);
    // The menu's slider has whole numbers from 0 on, of which the engine's Vulkan renderer takes 0 as 1; 2 is its default.
    constexpr float menu_default = 2;
    uniforms.intensity = std::clamp(cvars.vk_intensity, 1.0f, 10.0f) / menu_default;
    uniforms.cvars = cvars::shader_values();
    uniforms.flags = (view.underwater ? shared::FRAME_UNDERWATER : 0)
        | (cvars.r_fullbright != 0 ? shared::FRAME_FULLBRIGHT : 0)
        | (cvars.r_lightmap != 0 ? shared::FRAME_LIGHT_ALONE : 0)
        | (cvars.gl3_colorlight == 0 ? shared::FRAME_GREY_LIGHT : 0);
    return uniforms;
}

uint32_t Frame::write_uniforms(const shared::FrameUniforms& uniforms)
{
    const uint32_t offset = uint32_t(uniform_stride_) * (graphics_.slot() * max_views + views_this_frame_++);
    std::memcpy(uniforms_.mapped() + offset, &uniforms, sizeof(uniforms));
    return offset;
}

void Frame::bind(uint32_t uniform_offset)
{
    recorder_.begin(commands_, { backend_, light_sampler_ });
    const Bindings::ViewSets sets { scene_texels_, graphics_.screen.texels() };
    graphics_.bindings.bind(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, uniform_offset, sets);
    if (backend_ == TraceBackend::pipeline)
        graphics_.bindings.bind(commands_, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, uniform_offset, sets);
}

// The whole image pipeline, as passes.def has it.
void Frame::record_passes(const shared::FrameUniforms& uniforms)
{
    for (const Pass& pass : pass_rows)
        if (pass.is_run_with(uniforms.flags))
            for (const PassStep& step : pass_steps(pass, uniforms))
                recorder_.record(pass, step);
}

// What was averaged holds no longer if anything has changed.
void Frame::follow_changes(const View& view, bool average)
{
    CvarValues shown_by = cvars::values();
    shown_by.r_lightlevel = 0; // written by ourselves, every frame
    if (!average || !is_same(view, state_.view) || !(shown_by == state_.cvars))
        restart_accumulation();
    state_.view = view;
    state_.cvars = shown_by;
}

// A view without a world, such as the player's model in a menu, leaves what the world's views remember alone.
void Frame::prepare_menu(shared::FrameUniforms& uniforms) const
{
    uniforms.screen.accumulated = uniforms.screen.radiance;
    uniforms.accumulated_frames = 0;
    uniforms.exposure += sizeof(shared::ExposureState);
}

void Frame::record_view(const View& view, SceneSnapshot& scene, const GpuWorld* gpu_world, bool average)
{
    if (views_this_frame_ == max_views) {
        engine::print("vkpt: more than {} 3D views in one frame; the others are not shown", max_views);
        return;
    }
    // Averaged pictures and menus are complete.
    const glm::uvec2 size = average || !scene.world ? view.size : scaled_size(view.size);
    if (scene.world)
        follow_changes(view, average);
    commands_ = graphics_.commands();
    if (!scene.world)
        graphics_.screen.exchange_history(); // the world's last view lies safe under the names previous_
    shared::FrameUniforms uniforms = make_uniforms(view, size);
    if (!scene.world)
        prepare_menu(uniforms);
    begin_filters(uniforms, scene, gpu_world, average);
    state_.size = uniforms.resolved_size;
    state_.radiance = scene.world ? &graphics_.screen.accumulated() : &graphics_.screen.radiance();
    fill_scene(
        uniforms.scene, scene, gpu_world, uniforms.flags & shared::FRAME_HISTORY ? Motion::known : Motion::unknown);
    if (scene.world) {
        state_.rendered_size = size;
        uniforms.scene.oldest_repeatable = is_followed_by_another_ ? uniforms.frame_index
            : state_.lists_changed                                 ? state_.history_frame_index
                                                                   : 0;
        is_followed_by_another_ = false;
        state_.lists_changed = scene.world->light_lists.has_changed();
        state_.history_frame_index = uniforms.frame_index;
    }
    uniforms.time = scene.time;
    uniforms.dark_light_count = uint32_t(scene.dark_lights.size());
    uniforms.dark_lights = scene.dark_lights.empty() ? 0 : uploads_.push(scene.dark_lights);
    uniforms.flags |= (scene.has_alpha_test ? shared::FRAME_ALPHA_TEST : 0) | (scene.world ? 0 : shared::FRAME_NO_WORLD)
        | (average ? shared::FRAME_JITTER : 0);
    if (!average && scene.world)
        begin_bloom(uniforms);
    const bool counts_rays = cvars::values().pt_count_rays != 0;
    uniforms.flags |= counts_rays ? shared::FRAME_COUNT_RAYS : 0;
    bind(write_uniforms(uniforms));
    const VkPipelineStageFlags shaders = graphics_.device.shader_stages();
    // The picture may just have been cleared or drawn on, and the last frame may still be read.
    record_memory_barrier(
        commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT, shaders, shader_access);
    graphics_.timer.mark(commands_, "2d");
    if (counts_rays)
        record_clear_ray_counts();
    record_passes(uniforms);
    if (counts_rays)
        record_read_ray_counts();
    record_memory_barrier(
        commands_, shaders, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    if (scene.world)
        state_.accumulated_frames++;
    else
        graphics_.screen.exchange_history();
}

void Frame::record_clear_ray_counts() const
{
    vkCmdFillBuffer(commands_, ray_counts_.handle(), 0, sizeof(shared::RayCounts), 0);
    record_memory_barrier(commands_, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
        graphics_.device.shader_stages(), shader_access);
}

void Frame::record_read_ray_counts() const
{
    record_memory_barrier(commands_, graphics_.device.shader_stages(), VK_ACCESS_SHADER_WRITE_BIT,
        VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    const VkBufferCopy region { 0, 0, sizeof(shared::RayCounts) };
    vkCmdCopyBuffer(commands_, ray_counts_.handle(), read_ray_counts_.handle(), 1, &region);
    record_memory_barrier(commands_, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
        VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

shared::RayCounts Frame::read_ray_counts() const
{
    shared::RayCounts counts;
    std::memcpy(&counts, read_ray_counts_.mapped(), sizeof counts);
    return counts;
}

bool Frame::read_radiance(float* rgb)
{
    const size_t pixels = size_t(state_.size.x) * state_.size.y, bytes = pixels * sizeof(glm::vec4);
    if (bytes == 0 || !state_.radiance)
        return false;
    const Buffer copy = graphics_.read_back(*state_.radiance, bytes);
    for (size_t i = 0; i < pixels; i++)
        std::memcpy(rgb + 3 * i, copy.mapped() + i * sizeof(glm::vec4), sizeof(glm::vec3));
    return true;
}

} // namespace vkpt
