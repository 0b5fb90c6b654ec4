// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/frame.hpp"

#include "ref_vkpt/engine/engine.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace vkpt {

namespace {

// 3D views that one frame can hold; the engine draws one or two.
constexpr uint32_t max_views = 16;
// With a fixed pt_seed the numbers of a run do not depend on how long the game has been running.
constexpr float first_frame_seconds = 1.0f / 60;

constexpr VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
constexpr VkAccessFlags shader_access = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;

// What one pass wrote, the next one reads.
void record_pass_barrier(VkCommandBuffer commands)
{
    record_memory_barrier(commands, compute, VK_ACCESS_SHADER_WRITE_BIT, compute, shader_access);
}

shared::BvhView make_bvh_view(const Bvh& bvh, VkDeviceAddress nodes, VkDeviceAddress triangles)
{
    shared::BvhView view;
    view.nodes = nodes;
    view.triangles = triangles;
    view.grid_origin = bvh.grid_origin;
    view.grid_scale = bvh.grid_scale;
    return view;
}

// What a map's data looks like to the shaders where there is no map: one list with every emitter.
struct NoWorld {
    std::vector<shared::LightList> lists;
    std::vector<uint32_t> indices;
    std::vector<shared::BspTreeNode> tree;
};

NoWorld make_no_world(size_t emitter_count)
{
    constexpr int outside = -1;
    NoWorld result;
    result.lists.push_back({ 0, 0, 0, uint32_t(emitter_count) });
    for (uint32_t i = 0; i < emitter_count; i++)
        result.indices.push_back(i);
    result.tree.push_back({ glm::vec3(0, 0, 1), 0, outside, outside });
    return result;
}

} // namespace

GpuWorld upload_world(const World& world, Uploader& uploader)
{
    static uint64_t versions = 0;
    GpuWorld gpu;
    gpu.bvh_nodes = uploader.make_buffer(world.bvh.nodes, MemoryKind::acceleration, "world BVH nodes");
    gpu.bvh_triangles = uploader.make_buffer(world.bvh.triangles, MemoryKind::acceleration, "world BVH triangles");
    gpu.light_indices = uploader.make_buffer(world.light_lists.static_indices(), MemoryKind::lights, "light lists");
    gpu.bsp_tree = uploader.make_buffer(world.light_lists.tree(), MemoryKind::geometry, "BSP tree");
    gpu.version = ++versions;
    return gpu;
}

Frame::Frame(Graphics& graphics)
    : graphics_(graphics)
    , uploads_(graphics.gpu, MemoryKind::staging)
    , triangles_(graphics.gpu, MemoryKind::geometry, "triangles")
    , emitters_(graphics.gpu, MemoryKind::lights, "emitters")
{
    const VkDeviceSize alignment = graphics.device.properties.limits.minUniformBufferOffsetAlignment;
    uniform_stride_ = (sizeof(shared::FrameUniforms) + alignment - 1) / alignment * alignment;
    uniforms_ = Buffer(graphics.gpu, uniform_stride_ * max_views * frames_in_flight, BufferHome::upload,
        MemoryKind::staging, "frame uniforms");
    exposure_ = graphics.uploader.make_buffer(
        std::vector<shared::ExposureState>(1), MemoryKind::images, "exposure");
    readback_ = Buffer(
        graphics.gpu, sizeof(float) * frames_in_flight, BufferHome::readback, MemoryKind::staging, "light level");
    std::memset(readback_.mapped(), 0, readback_.size());
    graphics.bindings.bind_uniforms(uniforms_, sizeof(shared::FrameUniforms));
    graphics.uploader.flush();
}

Frame::~Frame() { vkDeviceWaitIdle(graphics_.device.handle); }

void Frame::begin()
{
    views_this_frame_ = 0;
    uploads_.begin_frame(graphics_.slot());
    std::memcpy(&light_level_, readback_.mapped() + graphics_.slot() * sizeof(float), sizeof(float));
    // Room for the largest view now: once recording refers to the buffers, they cannot be replaced.
    const VkExtent2D output = graphics_.size();
    reserve(scaled_size({ output.width, output.height }));
}

glm::uvec2 Frame::scaled_size(glm::uvec2 size)
{
    return glm::max(size * uint32_t(cvars::values().pt_view_scale) / 100u, glm::uvec2(1));
}

void Frame::reserve(glm::uvec2 size)
{
    if (!graphics_.screen.must_grow(size))
        return;
    graphics_.finish();
    graphics_.screen.reserve_pixels(size);
    restart_accumulation();
}

shared::FrameUniforms Frame::make_uniforms(const View& view, glm::uvec2 size)
{
    const CvarValues& cvars = cvars::values();
    const auto now = std::chrono::steady_clock::now();
    const float seconds = std::chrono::duration<float>(now - last_view_time_).count();
    last_view_time_ = now;

    shared::FrameUniforms uniforms {};
    uniforms.camera = view.camera;
    uniforms.screen = graphics_.screen.addresses();
    uniforms.exposure = exposure_.address();
    uniforms.light_level = readback_.address() + graphics_.slot() * sizeof(float);
    uniforms.size = size;
    uniforms.output_origin = glm::uvec2(view.origin);
    uniforms.output_size = view.size;
    uniforms.frame_seconds = cvars.pt_seed > 0 ? first_frame_seconds : std::min(seconds, 1.0f);
    uniforms.seed = uint32_t(cvars.pt_seed);
    uniforms.frame_index = cvars.pt_seed > 0 ? accumulated_frames_ : noise_index_++;
    uniforms.accumulated_frames = accumulated_frames_;
    uniforms.blend = view.blend;
    uniforms.gamma = cvars.vid_gamma;
    uniforms.cvars = cvars::shader_values();
    uniforms.flags = view.underwater ? shared::FRAME_UNDERWATER : 0;
    return uniforms;
}

void Frame::fill_scene(shared::SceneView& out, SceneSnapshot& scene, const GpuWorld* gpu_world)
{
    static const std::vector<shared::Triangle> no_triangles;
    static const std::vector<shared::Emitter> no_emitters;
    const uint32_t slot = graphics_.slot();
    const MapGeometry* world = scene.world ? &scene.world->models[0] : nullptr;
    const uint64_t version = gpu_world ? gpu_world->version : UINT64_MAX;
    out.triangles = triangles_.update(slot, world ? world->triangles : no_triangles, version, scene.triangles);
    out.emitters = emitters_.update(slot, world ? world->emitters : no_emitters, version, scene.emitters);
    out.materials = uploads_.push(scene.materials);
    out.lightstyles = uploads_.push(scene.lightstyles);
    out.trace_stack = graphics_.screen.trace_stack();
    out.sky = scene.sky;

    const shared::BvhView moving
        = make_bvh_view(scene.bvh, uploads_.push(scene.bvh.nodes), uploads_.push(scene.bvh.triangles));
    if (!world) {
        const NoWorld none = make_no_world(scene.emitters.size());
        out.trees[0] = moving;
        out.tree_count = 1;
        out.light_lists = uploads_.push(none.lists);
        out.static_light_indices = out.dynamic_light_indices = uploads_.push(none.indices);
        out.bsp_tree = uploads_.push(none.tree);
        out.light_list_count = 1;
        return;
    }
    const LightLists& lights = scene.world->light_lists;
    out.trees[0] = make_bvh_view(scene.world->bvh, gpu_world->bvh_nodes.address(), gpu_world->bvh_triangles.address());
    out.trees[1] = moving;
    out.tree_count = scene.bvh.triangle_count > 0 ? 2 : 1;
    out.light_lists = uploads_.push(lights.lists());
    out.static_light_indices = gpu_world->light_indices.address();
    out.dynamic_light_indices = uploads_.push(lights.dynamic_indices());
    out.bsp_tree = gpu_world->bsp_tree.address();
    out.light_list_count = uint32_t(lights.lists().size());
}

uint32_t Frame::write_uniforms(const shared::FrameUniforms& uniforms)
{
    const uint32_t offset = uint32_t(uniform_stride_) * (graphics_.slot() * max_views + views_this_frame_++);
    std::memcpy(uniforms_.mapped() + offset, &uniforms, sizeof(uniforms));
    return offset;
}

void Frame::record_pipeline(const char* name, const std::string& shader, uint32_t groups)
{
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, graphics_.pipelines.compute(shader));
    vkCmdDispatch(commands_, groups, 1, 1);
    record_pass_barrier(commands_);
    graphics_.timer.mark(commands_, name);
}

void Frame::record_pass(const char* name, uint32_t groups)
{
    record_pipeline(name, std::string(name) + ".comp", groups);
}

// A pass that chooses lights: its shader was built once for each light sampler.
void Frame::record_lit_pass(const char* name, uint32_t groups)
{
    record_pipeline(name, std::string(name) + ".comp:" + cvars::values().pt_light_sampler, groups);
}

// The whole image pipeline. A pass is its shader's name; what it reads and writes is in shared/screen_buffers.def.
void Frame::record_passes(const shared::FrameUniforms& uniforms, Surfaces surfaces, bool world)
{
    const uint32_t pixels = pixel_groups(uniforms.size);
    record_pass(surfaces == Surfaces::camera ? "primary_visibility" : "probe_surfaces", pixels);
    record_lit_pass("direct_light", pixels);
    if (uniforms.cvars.pt_bounces > 0)
        record_lit_pass("indirect_light", pixels);
    record_pass("accumulate", pixels);
    if (surfaces == Surfaces::probes)
        return;
    if (world)
        record_lit_pass("light_level", 1);
    record_pass("exposure", 1);
    record_pass("tone_map", pixel_groups(uniforms.output_size));
}

void Frame::record_view(const View& view, SceneSnapshot& scene, const GpuWorld* gpu_world, bool average)
{
    if (views_this_frame_ == max_views) {
        engine::print("vkpt: more than {} 3D views in one frame; the rest is not shown", max_views);
        return;
    }
    const glm::uvec2 size = scaled_size(view.size);
    CvarValues shown_by = cvars::values();
    shown_by.r_lightlevel = 0; // written by ourselves, every frame
    if (!average || !is_same(view, last_view_) || !(shown_by == last_cvars_))
        restart_accumulation();
    last_view_ = view;
    last_cvars_ = shown_by;
    view_size_ = size;

    commands_ = graphics_.commands();
    shared::FrameUniforms uniforms = make_uniforms(view, size);
    fill_scene(uniforms.scene, scene, gpu_world);
    uniforms.time = scene.time;
    uniforms.flags |= (scene.has_alpha_test ? shared::FRAME_ALPHA_TEST : 0) | (scene.world ? 0 : shared::FRAME_NO_WORLD)
        | (average ? shared::FRAME_JITTER : 0);
    graphics_.bindings.bind(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, write_uniforms(uniforms));
    // The picture may just have been cleared or drawn on, and the last frame may still be read.
    record_memory_barrier(commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT, compute, shader_access);
    graphics_.timer.mark(commands_, "2d");
    record_passes(uniforms, Surfaces::camera, scene.world != nullptr);
    record_memory_barrier(commands_, compute, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    accumulated_frames_++;
}

bool Frame::read_radiance(float* rgb)
{
    const size_t bytes = size_t(view_size_.x) * view_size_.y * sizeof(glm::vec3);
    if (bytes == 0)
        return false;
    const Buffer copy(graphics_.gpu, bytes, BufferHome::readback, MemoryKind::staging, "radiance readback");
    graphics_.run_once([&](VkCommandBuffer commands) {
        record_memory_barrier(commands, compute, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
        const VkBufferCopy region { 0, 0, bytes };
        vkCmdCopyBuffer(commands, graphics_.screen.accumulated().handle(), copy.handle(), 1, &region);
        record_memory_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    });
    std::memcpy(rgb, copy.mapped(), bytes);
    return true;
}

void Frame::measure_irradiance(std::span<const IrradianceProbe> probes, uint32_t samples, SceneSnapshot& scene,
    const GpuWorld& gpu_world, float* rgb)
{
    static_assert(sizeof(IrradianceProbe) == 6 * sizeof(float));
    constexpr uint32_t row = 1024;
    View view;
    view.size = { std::min<uint32_t>(row, uint32_t(probes.size())), (uint32_t(probes.size()) + row - 1) / row };
    graphics_.finish();
    reserve(view.size);
    view_size_ = view.size;
    for (uint32_t sample = 0; sample < samples; sample++) {
        accumulated_frames_ = sample;
        graphics_.run_once([&](VkCommandBuffer commands) {
            commands_ = commands;
            begin();
            shared::FrameUniforms uniforms = make_uniforms(view, view.size);
            fill_scene(uniforms.scene, scene, &gpu_world);
            uniforms.frame_index = sample;
            uniforms.probes = uploads_.push(std::as_bytes(probes));
            uniforms.probe_count = uint32_t(probes.size());
            uniforms.flags = shared::FRAME_PROBES | (scene.has_alpha_test ? shared::FRAME_ALPHA_TEST : 0);
            graphics_.bindings.bind(commands, VK_PIPELINE_BIND_POINT_COMPUTE, write_uniforms(uniforms));
            graphics_.timer.begin_frame(commands, graphics_.slot());
            record_passes(uniforms, Surfaces::probes, true);
        });
    }
    std::vector<float> picture(size_t(view.size.x) * view.size.y * 3);
    read_radiance(picture.data());
    std::copy_n(picture.data(), probes.size() * 3, rgb);
    restart_accumulation();
}

} // namespace vkpt
