// SPDX-License-Identifier: GPL-2.0-or-later
// The frame: from a scene and a camera to the picture, by the straight list of passes in shaders/passes.def.
#pragma once

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/extension.hpp"
#include "ref_vkpt/frame/gpu_world.hpp"
#include "ref_vkpt/frame/graphics.hpp"
#include "ref_vkpt/frame/outline_upload.hpp"
#include "ref_vkpt/frame/pass_recorder.hpp"
#include "ref_vkpt/frame/render_scale.hpp"
#include "ref_vkpt/frame/scene_texels.hpp"
#include "ref_vkpt/frame/uploads.hpp"
#include "ref_vkpt/frame/view_history.hpp"
#include "ref_vkpt/scene/snapshot.hpp"
#include "ref_vkpt/trace/acceleration_structures.hpp"
#include "ref_vkpt/trace/backend.hpp"

#include <chrono>
#include <memory>
#include <span>

namespace vkpt {

// What a view of the world keeps from one of its frames to the next, beside its buffers.
struct ViewState {
    View view;
    CvarValues cvars;
    glm::uvec2 size { 0 }, rendered_size { 0 };
    const Buffer* radiance = nullptr; // the last view's
    ViewHistory history;
    bool lists_changed = false;
    uint32_t history_frame_index = 0, offset_index = 0, accumulated_frames = 0, noise_index = 0;
    std::chrono::steady_clock::time_point time;
};

// A view that is drawn now and then, while others are.
struct ParkedView {
    Screen::ViewBuffers buffers;
    Buffer exposure;
    ViewState state;
};

class Frame {
public:
    Frame(Graphics& graphics, Workers& workers);
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    // After Graphics::begin_frame.
    void begin();
    // Records one view. `gpu_world` belongs to scene.world. `average`: go on averaging if nothing changed since the
    // last view, else start anew.
    void record_view(const View& view, SceneSnapshot& scene, const GpuWorld* gpu_world, bool average);
    // Between frames: takes up `parked` and leaves there what the view drawn so far keeps (view_slots.cpp).
    void exchange_view(ParkedView& parked);
    void prepare_view();
    // How the next views' rays are traced; the device offers it.
    void set_trace_backend(TraceBackend backend) { backend_ = backend; }
    TraceBackend trace_backend() const { return backend_; }
    // The light sampler of the next views; the device has its tables.
    void set_light_sampler(std::string_view sampler)
    {
        if (sampler != light_sampler_)
            restart_accumulation();
        light_sampler_ = sampler;
    }
    // The map has gone; the device is idle.
    void forget_world()
    {
        structures_.forget_world();
        state_.radiance = nullptr;
    }
    // Bytes of the map's acceleration structure per triangle, in the backend that is used.
    double bytes_per_triangle(const World& world) const;

    // Forgets what was averaged: the next view is the first.
    void restart_accumulation() { state_.accumulated_frames = 0; }
    uint32_t accumulated_frames() const { return state_.accumulated_frames; }

    // Of the last frame's last view, where pt_count_rays was 1. The device must be idle.
    shared::RayCounts read_ray_counts() const;

    // Light at the player in the newest finished frame, as radiance of a white floor.
    float light_level() const { return light_level_; }

    // The last view's accumulated radiance. The device must be idle.
    bool read_radiance(float* rgb);
    // Whether a view has been drawn, so that there is a picture to read.
    bool has_radiance() const { return state_.radiance != nullptr; }
    // Pixels of read_radiance.
    glm::uvec2 view_size() const { return state_.size; }
    // Pixels that the last view of the world rendered.
    glm::uvec2 rendered_size() const { return state_.rendered_size; }
    // Pixels since the start whose light was not a number, or infinite, in the frames that have finished.
    uint64_t broken_pixels() const { return broken_pixels_; }
    const View& last_view() const { return state_.view; }
    // Irradiance / pi at points, see Extension. Between frames.
    void measure_irradiance(std::span<const IrradianceProbe> probes, uint32_t samples, SceneSnapshot& scene,
        const GpuWorld& gpu_world, float* rgb);
    // Traces rays through the scene by the backend in use, see Extension. Between frames. Returns the seconds of one
    // round.
    double trace_rays(std::span<const TracedRay> rays, const TraceRequest& request, SceneSnapshot& scene,
        const GpuWorld& gpu_world, TracedHit* hits);

    // See Extension (inspect.cpp). Between frames.
    bool inspect_pixel(glm::uvec2 pixel, SceneSnapshot& scene, const GpuWorld& gpu_world, InspectedSurface& surface,
        std::span<InspectedLight> lights);

private:
    // What the device keeps of the scene from frame to frame; little of it is written in each.
    struct SceneUploads {
        SceneUploads(const Gpu& gpu, const Bindings& bindings);
        std::unique_ptr<SceneTexels> texels; // stays where it is while other views come
        PrefixedUpload triangles, emitters, tree_nodes, tree_triangles;
        OutlineUpload outlines;
        KeptUpload materials, light_lists, dynamic_light_indices;
    };
    Buffer make_exposure();
    shared::FrameUniforms make_uniforms(const View& view, glm::uvec2 size);
    // known: primary_visibility asks where moving things were in the last view.
    enum class Motion { unknown, known };
    void fill_scene(shared::SceneView& out, SceneSnapshot& scene, const GpuWorld* gpu_world, Motion motion);
    void write_trees(
        shared::SceneView& out, const SceneSnapshot& scene, const GpuWorld* gpu_world, MovingTarget target);
    void fill_structures(
        shared::SceneView& out, const SceneSnapshot& scene, const GpuWorld* gpu_world, const MovingTarget& target);
    uint32_t write_uniforms(const shared::FrameUniforms& uniforms);
    void bind(uint32_t uniform_offset);
    void record_clear_ray_counts() const;
    void record_read_ray_counts() const;
    void record_passes(const shared::FrameUniforms& uniforms);
    void begin_filters(
        shared::FrameUniforms& uniforms, const SceneSnapshot& scene, const GpuWorld* gpu_world, bool average);
    void trace_chunk(std::span<const TracedRay> rays, uint32_t row, const TraceRequest& request, SceneSnapshot& scene,
        const GpuWorld& gpu_world, TracedHit* hits, double& seconds);
    static RenderScale::Limits scale_limits();
    glm::uvec2 scaled_size(glm::uvec2 size) const; // by pt_render_scale and pt_target_ms
    void read_statistics();
    void follow_changes(const View& view, bool average);
    void prepare_menu(shared::FrameUniforms& uniforms) const;
    void reserve(glm::uvec2 size);

    Graphics& graphics_;
    PassRecorder recorder_;
    FrameUploads uploads_;
    // By the view's number in the frame: all views are drawn after all have been described.
    std::vector<SceneUploads> scene_uploads_;
    VkDescriptorSet scene_texels_ = VK_NULL_HANDLE; // of the view that is recorded
    MovingWriter moving_writer_;
    AccelerationStructures structures_;
    TraceBackend backend_ = TraceBackend::software;
    std::string light_sampler_;
    Buffer uniforms_, exposure_, ltc_, blue_noise_, readback_, statistics_, ray_counts_, read_ray_counts_;
    VkDeviceSize uniform_stride_;
    uint32_t views_this_frame_ = 0;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;

    ViewState state_; // of the view that is drawn
    RenderScale render_scale_;
    uint64_t broken_pixels_ = 0;
    bool is_followed_by_another_ = false; // another view came since its last frame, and the light lists went on with it
    float light_level_ = 0;
};

} // namespace vkpt
