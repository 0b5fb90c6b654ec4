// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/frame.hpp"

#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/frame/air.hpp"
#include "ref_vkpt/frame/bloom.hpp"
#include "ref_vkpt/lights/ltc_table.hpp"
#include "ref_vkpt/noise/blue_noise.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

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
    , scene_upload_(graphics, workers)
{
    const VkDeviceSize alignment = graphics.device.properties.limits.minUniformBufferOffsetAlignment;
    uniform_stride_ = (sizeof(shared::FrameUniforms) + alignment - 1) / alignment * alignment;
    uniforms_ = Buffer(graphics.gpu, uniform_stride_ * max_views * frames_in_flight, BufferHome::upload,
        MemoryKind::staging, "frame uniforms");
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

void Frame::begin(View& view)
{
    views_this_frame_ = 0;
    told_of_views_ = false;
    scene_upload_.begin_frame();
    std::array<float, shared::LIGHT_LEVEL_LANES> lanes;
    std::memcpy(lanes.data(), readback_.mapped() + graphics_.slot() * light_level_bytes, light_level_bytes);
    light_level_ = std::accumulate(lanes.begin(), lanes.end(), 0.0f) / float(lanes.size());
    read_statistics();
    for (const double milliseconds : graphics_.timer.take_scaled_milliseconds())
        render_scale_.add_frame(milliseconds, scale_limits());
    // Room for the largest view now: once recording refers to the buffers, they cannot be replaced. For the whole
    // window, though fewer pixels may be rendered, so that a change of the render size costs nothing.
    const VkExtent2D output = graphics_.size();
    reserve(view, { output.width, output.height });
    if (!view.exposure) {
        view.exposure
            = graphics_.uploader.make_buffer(std::vector<shared::ExposureState>(2), MemoryKind::images, "exposure");
        graphics_.uploader.flush();
    }
}

// Of the slot's last frame, which has finished.
void Frame::read_statistics()
{
    std::byte* const mapped = statistics_.mapped() + graphics_.slot() * sizeof(shared::FrameStatistics);
    shared::FrameStatistics statistics;
    std::memcpy(&statistics, mapped, sizeof(statistics));
    std::memset(mapped, 0, sizeof(statistics));
    if (statistics.nonfinite_pixels > 0 && nonfinite_pixels_ == 0)
        engine::print(
            "ref_vkpt: the light of {} pixels is not finite, they are shown black; pt_info counts them. Please "
            "report the map, the position and the settings",
            statistics.nonfinite_pixels);
    nonfinite_pixels_ += statistics.nonfinite_pixels;
    constexpr double kept = 0.99;
    cut_light_ = kept * cut_light_ + statistics.cut_light;
    sampled_light_ = kept * sampled_light_ + statistics.sampled_light;
}

double Frame::cut_light_share() const
{
    const bool is_filtered = cvars::shader_values().flt_denoiser != shared::DENOISER_OFF;
    return is_filtered && sampled_light_ > 0 ? cut_light_ / sampled_light_ : 0;
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

void Frame::reserve(View& view, glm::uvec2 size)
{
    const ViewBuffers::Extras extras {
        .trace_stacks = trace_backend() == TraceBackend::software && !graphics_.device.traits.gpu_lanes,
        .ray_counts = cvars::shader_values().pt_debug_view == shared::DEBUG_VIEW_RAYS,
    };
    if (!view.buffers.must_grow(size, extras))
        return;
    graphics_.finish();
    view.buffers.reserve_pixels(graphics_.gpu, graphics_.bindings, size, extras);
    view.radiance = nullptr;
    view.accumulated_frames = 0;
    view.history.forget();
}

shared::FrameUniforms Frame::make_uniforms(View& view, const Viewpoint& from, glm::uvec2 size)
{
    const CvarValues& cvars = cvars::values();
    const auto now = std::chrono::steady_clock::now();
    const float seconds = std::chrono::duration<float>(now - view.time).count();
    view.time = now;

    shared::FrameUniforms uniforms {};
    uniforms.camera = from.camera;
    uniforms.pixel_offset = glm::vec2(0.5f);
    uniforms.screen = view.buffers.rows();
    uniforms.exposure = view.exposure.address();
    uniforms.statistics = statistics_.address() + graphics_.slot() * sizeof(shared::FrameStatistics);
    uniforms.ltc = ltc_.address();
    uniforms.blue_noise = blue_noise_.address();
    uniforms.ray_counts = ray_counts_.address();
    uniforms.light_level = readback_.address() + graphics_.slot() * light_level_bytes;
    uniforms.size = uniforms.resolved_size = uniforms.previous_size = size;
    uniforms.previous_scale = glm::vec2(1);
    uniforms.output_words = graphics_.output.words.address();
    uniforms.output_across = graphics_.size().width;
    uniforms.headroom = graphics_.headroom();
    uniforms.highlights = uniforms.headroom > 1 ? graphics_.output.highlights.address() : 0;
    uniforms.output_origin = glm::uvec2(from.origin);
    uniforms.output_size = from.size;
    uniforms.frame_seconds = cvars.pt_seed > 0 ? first_frame_seconds : std::min(seconds, 1.0f);
    uniforms.seed = uint32_t(cvars.pt_seed);
    uniforms.frame_index = cvars.pt_seed > 0 ? view.accumulated_frames : view.noise_index++;
    uniforms.bounce_block = glm::uvec2(1);
    uniforms.accumulated_frames = view.accumulated_frames;
    uniforms.blend = cvars.gl_polyblend != 0 ? from.blend : glm::vec4(0);
    uniforms.gamma = cvars.vid_gamma;
    uniforms.overbright = std::clamp(cvars.vk_overbrightbits, 0.0f, 100.0f);
    // The menu's slider has whole numbers from 0 on, of which the engine's Vulkan renderer takes 0 as 1; 2 is its
    // default.
    constexpr float menu_default = 2;
    uniforms.intensity = std::clamp(cvars.vk_intensity, 1.0f, 10.0f) / menu_default;
    uniforms.cvars = cvars::shader_values();
    uniforms.cvars.pt_exposure_bias += from.exposure_stops;
    uniforms.cvars.pt_projection = from.projection;
    uniforms.cvars.pt_water_warp *= from.is_photo ? 0.0f : 1.0f;
    uniforms.texture_taps = float(std::clamp(cvars.r_anisotropic, 1, graphics_.device.traits.max_texture_taps));
    uniforms.flags = (from.underwater ? shared::FRAME_UNDERWATER : 0)
        | (cvars.r_fullbright != 0 ? shared::FRAME_FULLBRIGHT : 0)
        | (cvars.r_lightmap != 0 ? shared::FRAME_LIGHT_ALONE : 0)
        | (cvars.gl3_colorlight == 0 ? shared::FRAME_GREY_LIGHT : 0)
        | (cvars.gl_texturemode.starts_with("GL_NEAREST") ? shared::FRAME_NEAREST_TEXELS : 0);
    return uniforms;
}

uint32_t Frame::write_uniforms(const shared::FrameUniforms& uniforms)
{
    const uint32_t offset = uint32_t(uniform_stride_) * (graphics_.slot() * max_views + views_this_frame_++);
    std::memcpy(uniforms_.mapped() + offset, &uniforms, sizeof(uniforms));
    return offset;
}

void Frame::bind(VkCommandBuffer commands, const View& view, uint32_t uniform_offset)
{
    recorder_.begin(commands, shaders_);
    const Bindings::ViewSets sets { scene_texels_, view.buffers.texels() };
    graphics_.bindings.bind(commands, VK_PIPELINE_BIND_POINT_COMPUTE, uniform_offset, sets);
    if (trace_backend() == TraceBackend::pipeline)
        graphics_.bindings.bind(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, uniform_offset, sets);
}

// What shows an average that has all its samples.
static bool shows_average(PassId id) { return id == PassId::exposure || id == PassId::tone_map; }

// The whole image pipeline, as passes.def has it.
void Frame::record_passes(const shared::FrameUniforms& uniforms, bool average_is_complete)
{
    for (const Pass& pass : pass_rows)
        if (pass.is_run_with(uniforms.flags) && (!average_is_complete || shows_average(pass.id)))
            for (const PassStep& step : pass_steps(pass, uniforms))
                recorder_.record(pass, step);
}

// What was averaged holds no longer if anything has changed.
void Frame::follow_changes(View& view, const Viewpoint& from, bool average) const
{
    const CvarValues shown_by = cvars::players_values();
    if (!average || !is_same(from, view.viewpoint) || !(shown_by == view.cvars)
        || shaders_.light_sampler != view.light_sampler)
        view.accumulated_frames = 0;
    view.viewpoint = from;
    view.cvars = shown_by;
    view.light_sampler = shaders_.light_sampler;
}

void Frame::fill_scene(shared::FrameUniforms& uniforms, VkCommandBuffer commands, const View& view,
    const SceneSnapshot& scene, const GpuWorld* gpu_world)
{
    const SceneUpload::Use use { commands, views_this_frame_, trace_backend(), view.buffers.trace_stack(),
        (uniforms.flags & shared::FRAME_HISTORY) != 0 };
    scene_texels_ = scene_upload_.fill(uniforms.scene, scene, gpu_world, use);
    uniforms.flags |= scene.has_alpha_test ? shared::FRAME_ALPHA_TEST : 0;
    fill_air(uniforms, scene);
    std::ranges::copy(scene.screens, uniforms.scene.screens);
    if (uniforms.cvars.pt_wipe > 0 && uniforms.scene.lightmap_faces != 0)
        uniforms.flags |= shared::FRAME_WIPE;
}

// For what the device does about a frame's scene before its shaders run: nothing, where the CPU builds the trees and
// writes right into the device's memory.
VkCommandBuffer Frame::upload_commands()
{
    const bool has_work = trace_backend() != TraceBackend::software || !graphics_.device.maps_all_memory;
    return has_work && cvars::values().pt_async != 0 ? graphics_.async_commands() : graphics_.commands();
}

shared::FrameUniforms Frame::begin_query(
    VkCommandBuffer commands, View& view, const Viewpoint& from, const SceneSnapshot& scene, const GpuWorld& gpu_world)
{
    begin(view);
    graphics_.timer.begin_untimed(graphics_.slot());
    shared::FrameUniforms uniforms = make_uniforms(view, from, from.size);
    fill_scene(uniforms, commands, view, scene, &gpu_world);
    return uniforms;
}

namespace {

// A view without a world, such as the player's model in a menu, leaves what the world's views remember alone, but for
// their samples. Nothing is filtered.
void prepare_menu(shared::FrameUniforms& uniforms)
{
    uniforms.screen.accumulated = uniforms.screen.filtered;
    uniforms.accumulated_frames = 0;
    uniforms.exposure += sizeof(shared::ExposureState);
    uniforms.flags |= shared::FRAME_NO_WORLD;
}

// What the world's next frame asks about this one.
void keep_lists(View& view, shared::FrameUniforms& uniforms, const SceneSnapshot& scene, uint32_t publications,
    uint32_t light_visibility)
{
    const uint32_t flags = uniforms.flags & (shared::FRAME_LIGHT_CACHE | shared::FRAME_GUIDES);
    const View::LightCacheUse light_cache { flags, flags ? publications : 0 };
    // With the cache rays go elsewhere than without, and with new values they bring something else. New weights choose
    // other lights. With a fixed seed all frames have the same index.
    const bool differs = std::exchange(view.samples_are_lost, false) || light_cache != view.light_cache
        || light_visibility != view.light_visibility;
    uniforms.scene.oldest_repeatable = differs ? std::numeric_limits<uint32_t>::max()
        : view.lists_changed                   ? view.history_frame_index
                                               : 0;
    view.light_cache = light_cache;
    view.light_visibility = light_visibility;
    view.lists_changed = scene.light_lists->has_changed();
    view.history_frame_index = uniforms.frame_index;
}

} // namespace

void Frame::record_view(
    View& view, const Viewpoint& from, const SceneSnapshot& scene, const GpuWorld* gpu_world, bool average)
{
    if (views_this_frame_ == max_views) {
        if (!std::exchange(told_of_views_, true))
            engine::print("vkpt: more than {} 3D views in one frame; the others are not shown", max_views);
        return;
    }
    const bool has_world = scene.world != nullptr;
    if (has_world)
        follow_changes(view, from, average);
    else
        view.buffers.exchange_history(); // the world's last frame lies safe under the names previous_
    // Averaged images and menus are complete.
    const bool is_scaled = has_world && !average;
    const glm::uvec2 size = is_scaled ? scaled_size(from.size) : from.size;
    if (is_scaled)
        graphics_.timer.note_scaled_view();
    shared::FrameUniforms uniforms = make_uniforms(view, from, size);
    if (!has_world)
        prepare_menu(uniforms);
    begin_filters(uniforms, view, scene, gpu_world, average);
    view.radiance_size = uniforms.resolved_size;
    view.radiance = &view.buffers.buffer_of(uniforms.screen.accumulated);
    fill_scene(uniforms, upload_commands(), view, scene, gpu_world);
    if (has_world) {
        view.rendered_size = size;
        light_cache.begin_frame(graphics_.commands(), uniforms, *gpu_world, average);
        light_visibility.begin_frame(
            uniforms, *gpu_world, shaders_.light_sampler, uint32_t(scene.light_lists->static_emitter_count()));
        keep_lists(view, uniforms, scene, light_cache.publications(), light_visibility.state());
    }
    uniforms.time = scene.time;
    uniforms.dark_light_count = uint32_t(scene.dark_lights.size());
    uniforms.dark_lights = scene.dark_lights.empty() ? 0 : uploads().push(scene.dark_lights);
    if ((uniforms.flags & shared::FRAME_WIPE) && !scene.dlights.empty()) {
        uniforms.dlight_count = uint32_t(scene.dlights.size());
        uniforms.dlights = uploads().push(scene.dlights);
    }
    uniforms.flags |= average ? shared::FRAME_JITTER : 0;
    if (!average && has_world)
        begin_bloom(uniforms);
    uniforms.flags |= cvars::values().pt_count_rays != 0 ? shared::FRAME_COUNT_RAYS : 0;
    const bool is_complete = average && from.max_samples > 0 && view.accumulated_frames >= from.max_samples;
    record(graphics_.commands(), view, uniforms, is_complete);
    if (has_world)
        view.accumulated_frames += is_complete ? 0 : 1;
    else {
        view.buffers.exchange_history();
        view.samples_are_lost = true;
    }
}

void Frame::record(
    VkCommandBuffer commands, const View& view, const shared::FrameUniforms& uniforms, bool average_is_complete)
{
    bind(commands, view, write_uniforms(uniforms));
    const VkPipelineStageFlags shaders = graphics_.device.shader_stages();
    // The image may just have been cleared or drawn on, and the last frame may still be read.
    record_memory_barrier(
        commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT, shaders, shader_access);
    graphics_.timer.mark(commands, "2d");
    if (uniforms.flags & shared::FRAME_COUNT_RAYS)
        record_clear_ray_counts(commands);
    record_passes(uniforms, average_is_complete);
    if (uniforms.flags & shared::FRAME_COUNT_RAYS)
        record_read_ray_counts(commands);
    record_memory_barrier(
        commands, shaders, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

void Frame::record_clear_ray_counts(VkCommandBuffer commands) const
{
    vkCmdFillBuffer(commands, ray_counts_.handle(), 0, sizeof(shared::RayCounts), 0);
    record_memory_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
        graphics_.device.shader_stages(), shader_access);
}

void Frame::record_read_ray_counts(VkCommandBuffer commands) const
{
    record_memory_barrier(commands, graphics_.device.shader_stages(), VK_ACCESS_SHADER_WRITE_BIT,
        VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
    const VkBufferCopy region { 0, 0, sizeof(shared::RayCounts) };
    vkCmdCopyBuffer(commands, ray_counts_.handle(), read_ray_counts_.handle(), 1, &region);
    record_memory_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
        VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
}

shared::RayCounts Frame::read_ray_counts() const
{
    shared::RayCounts counts;
    std::memcpy(&counts, read_ray_counts_.mapped(), sizeof counts);
    return counts;
}

bool Frame::read_radiance(const View& view, float* rgb)
{
    const size_t pixels = size_t(view.radiance_size.x) * view.radiance_size.y, bytes = pixels * sizeof(glm::vec4);
    if (bytes == 0 || !view.radiance)
        return false;
    const Buffer copy = graphics_.read_back(*view.radiance, bytes);
    for (size_t i = 0; i < pixels; i++)
        std::memcpy(rgb + 3 * i, copy.mapped() + i * sizeof(glm::vec4), sizeof(glm::vec3));
    return true;
}

} // namespace vkpt
