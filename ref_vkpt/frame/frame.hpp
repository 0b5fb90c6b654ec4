// SPDX-License-Identifier: GPL-2.0-or-later
// The frame: from a scene and a camera to the image, by the straight list of passes in shaders/passes.def.
#pragma once

#include "ref_vkpt/frame/light_visibility.hpp"
#include "ref_vkpt/frame/pass_recorder.hpp"
#include "ref_vkpt/frame/render_scale.hpp"
#include "ref_vkpt/frame/scene_upload.hpp"
#include "ref_vkpt/frame/view.hpp"

#include <cstdint>
#include <string>

namespace vkpt {

class Frame {
public:
    Frame(Graphics& graphics, Workers& workers);
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    // After Graphics::begin_frame. `view` is the one that is drawn, and whose buffers menus use.
    void begin(View& view);
    // Records the view, or a menu's in its place. `gpu_world` belongs to scene.world. `average`: go on averaging if
    // nothing changed since the view's last frame, else start anew.
    void record_view(
        View& view, const Viewpoint& from, const SceneSnapshot& scene, const GpuWorld* gpu_world, bool average);
    // How the next views' rays are traced; the device offers it.
    void set_trace_backend(TraceBackend backend) { shaders_.backend = backend; }
    TraceBackend trace_backend() const { return shaders_.backend; }
    // The light sampler of the next views; the device has its tables.
    void set_light_sampler(std::string_view sampler) { shaders_.light_sampler = sampler; }
    // The map has gone; the device is idle.
    void forget_world() { scene_upload_.forget_world(); }
    // Bytes of the map's acceleration structure per triangle, in the backend that is used.
    double bytes_per_triangle(const World& world) const
    {
        return scene_upload_.bytes_per_triangle(world, trace_backend());
    }

    // Of the last frame's last view, where pt_count_rays was 1. The device must be idle.
    shared::RayCounts read_ray_counts() const;
    // Light at the player in the newest finished frame, as radiance of a white floor.
    float light_level() const { return light_level_; }
    // The view's accumulated radiance. The device must be idle. False: there is none.
    bool read_radiance(const View& view, float* rgb);
    // Pixels since the start whose light was not a number, or infinite, in the frames that have finished.
    uint64_t nonfinite_pixels() const { return nonfinite_pixels_; }
    // The share of the light, before surfaces' colours, that the limit on fireflies took in about the last hundred
    // filtered frames that have finished; 0 while nothing is filtered.
    double cut_light_share() const;

    // For questions between frames (scene_queries.cpp), in commands of their own.
    // Begins, and returns the uniforms of the scene as seen from there.
    shared::FrameUniforms begin_query(VkCommandBuffer commands, View& view, const Viewpoint& from,
        const SceneSnapshot& scene, const GpuWorld& gpu_world);
    void reserve(View& view, glm::uvec2 size);
    uint32_t write_uniforms(const shared::FrameUniforms& uniforms);
    // What is recorded from here on sees these.
    void bind(VkCommandBuffer commands, const View& view, uint32_t uniform_offset);
    // average_is_complete: only what shows it.
    void record_passes(const shared::FrameUniforms& uniforms, bool average_is_complete = false);
    PassRecorder& recorder() { return recorder_; }
    FrameUploads& uploads() { return scene_upload_.uploads(); }

    LightCacheKeeper light_cache;
    LightVisibilityKeeper light_visibility;

private:
    shared::FrameUniforms make_uniforms(View& view, const Viewpoint& from, glm::uvec2 size);
    void begin_filters(shared::FrameUniforms& uniforms, View& view, const SceneSnapshot& scene,
        const GpuWorld* gpu_world, bool average) const;
    void fill_scene(shared::FrameUniforms& uniforms, VkCommandBuffer commands, const View& view,
        const SceneSnapshot& scene, const GpuWorld* gpu_world);
    VkCommandBuffer upload_commands();
    void record(
        VkCommandBuffer commands, const View& view, const shared::FrameUniforms& uniforms, bool average_is_complete);
    void record_clear_ray_counts(VkCommandBuffer commands) const;
    void record_read_ray_counts(VkCommandBuffer commands) const;
    static RenderScale::Limits scale_limits();
    glm::uvec2 scaled_size(glm::uvec2 size) const; // by pt_render_scale and pt_target_ms
    void read_statistics();
    void follow_changes(View& view, const Viewpoint& from, bool average) const;

    Graphics& graphics_;
    PassRecorder recorder_;
    SceneUpload scene_upload_;
    VkDescriptorSet scene_texels_ = VK_NULL_HANDLE; // of the view that is recorded
    ShaderChoice shaders_;
    Buffer uniforms_, ltc_, blue_noise_, readback_, statistics_, ray_counts_, read_ray_counts_;
    VkDeviceSize uniform_stride_;
    uint32_t views_this_frame_ = 0;
    bool told_of_views_ = false; // that there were more than max_views
    RenderScale render_scale_;
    uint64_t nonfinite_pixels_ = 0;
    double cut_light_ = 0, sampled_light_ = 0; // see FrameStatistics; newer frames count for more
    float light_level_ = 0;
};

} // namespace vkpt
