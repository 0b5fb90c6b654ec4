// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/frame.hpp"

#include "ref_vkpt/engine/engine.hpp"
#include "ref_vkpt/frame/frame_shaders.hpp"
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
    gpu.bvh_nodes = uploader.make_buffer(world.bvh().nodes, MemoryKind::acceleration, "world BVH nodes");
    gpu.bvh_triangles = uploader.make_buffer(world.bvh().triangles, MemoryKind::acceleration, "world BVH triangles");
    gpu.light_indices = uploader.make_buffer(world.light_lists.static_indices(), MemoryKind::lights, "light lists");
    gpu.bsp_tree = uploader.make_buffer(world.light_lists.tree(), MemoryKind::geometry, "BSP tree");
    gpu.version = ++versions;
    return gpu;
}

Frame::Frame(Graphics& graphics, Workers& workers)
    : graphics_(graphics)
    , uploads_(graphics.gpu, MemoryKind::staging)
    , triangles_(graphics.gpu, MemoryKind::geometry, "triangles")
    , emitters_(graphics.gpu, MemoryKind::lights, "emitters")
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

Frame::~Frame() { vkDeviceWaitIdle(graphics_.device.handle); }

void Frame::begin()
{
    views_this_frame_ = 0;
    uploads_.begin_frame(graphics_.slot());
    structures_.begin_frame(graphics_.slot());
    std::array<float, shared::LIGHT_LEVEL_LANES> lanes;
    std::memcpy(lanes.data(), readback_.mapped() + graphics_.slot() * light_level_bytes, light_level_bytes);
    light_level_ = std::accumulate(lanes.begin(), lanes.end(), 0.0f) / float(lanes.size());
    read_statistics();
    double milliseconds = 0;
    for (const PassTime& time : graphics_.timer.times())
        milliseconds += time.milliseconds;
    render_scale_.add_frame(milliseconds, scale_limits());
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
        engine::print("ref_vkpt: the light of {} pixels is not a number and shown black; pt_info counts them. Please "
                      "report map, place and settings",
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
    radiance_ = nullptr;
    restart_accumulation();
    history_.forget();
}

shared::FrameUniforms Frame::make_uniforms(const View& view, glm::uvec2 size)
{
    const CvarValues& cvars = cvars::values();
    const auto now = std::chrono::steady_clock::now();
    const float seconds = std::chrono::duration<float>(now - last_view_time_).count();
    last_view_time_ = now;

    shared::FrameUniforms uniforms {};
    uniforms.camera = view.camera;
    uniforms.pixel_offset = glm::vec2(0.5f);
    uniforms.screen = graphics_.screen.addresses();
    uniforms.exposure = exposure_.address();
    uniforms.statistics = statistics_.address() + graphics_.slot() * sizeof(shared::FrameStatistics);
    uniforms.ltc = ltc_.address();
    uniforms.blue_noise = blue_noise_.address();
    uniforms.ray_counts = ray_counts_.address();
    uniforms.light_level = readback_.address() + graphics_.slot() * light_level_bytes;
    uniforms.size = uniforms.resolved_size = uniforms.previous_size = size;
    uniforms.previous_scale = glm::vec2(1);
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

void Frame::fill_scene(shared::SceneView& out, SceneSnapshot& scene, const GpuWorld* gpu_world, Motion motion)
{
    const CpuTimer timer("cpu upload");
    static const std::vector<shared::Triangle> no_triangles;
    static const std::vector<shared::Emitter> no_emitters;
    const uint32_t slot = graphics_.slot();
    const MapGeometry* world = scene.world ? &scene.world->models[0] : nullptr;
    const uint64_t version = gpu_world ? gpu_world->version : UINT64_MAX;
    const Upload triangles
        = triangles_.reserve(slot, world ? world->triangles : no_triangles, version, scene.moving.triangle_count());
    const LightLists* lights = world ? &scene.world->light_lists : nullptr;
    const bool repeats = lights && lights->has_changed() && motion == Motion::known;
    const LightLists::Repeated repeated = repeats ? lights->repeat() : LightLists::Repeated();
    // Lights that have gone stay in the repeated lists: dark.
    const size_t emitter_count = std::max(
        scene.emitters.size(), repeats ? repeated.emitter_count - lights->static_emitter_count() : size_t(0));
    const Upload emitters = emitters_.reserve(slot, world ? world->emitters : no_emitters, version, emitter_count);
    auto* const end = std::ranges::copy(scene.emitters, emitters.as<shared::Emitter>()).out;
    std::fill(end, emitters.as<shared::Emitter>() + emitter_count, shared::Emitter {});
    if (repeats) {
        out.repeated_lists = uploads_.push(repeated.lists);
        out.repeated_light_indices = uploads_.push(repeated.dynamic_indices);
        out.previous_list_lengths = uploads_.push(lights->previous_lengths());
    }
    out.triangles = triangles.address;
    out.emitters = emitters.address;
    out.materials = uploads_.push(scene.materials);
    out.lightstyles = uploads_.push(scene.lightstyles);
    out.trace_stack = graphics_.screen.trace_stack();
    out.sky = scene.sky;
    MovingTarget target;
    target.triangles = triangles.as<shared::Triangle>();
    out.first_moving = UINT32_MAX;
    if (motion == Motion::known && scene.moving.triangle_count() > 0) {
        using Corners = std::array<glm::vec3, 3>;
        const Upload previous = uploads_.reserve(scene.moving.triangle_count() * sizeof(Corners));
        target.previous_positions = previous.as<Corners>();
        out.previous_positions = previous.address;
        out.first_moving = scene.moving.first_id();
    }
    shared::BvhView moving {};
    if (backend_ == TraceBackend::software)
        moving = write_moving(scene.moving, target);
    else
        fill_structures(out, scene, gpu_world, target);

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
    const bool is_latest = scene.kept_lights.lists.empty();
    const Bvh& bvh = scene.world->bvh();
    out.trees[0]
        = { gpu_world->bvh_nodes.address(), gpu_world->bvh_triangles.address(), bvh.grid_origin, bvh.grid_scale };
    out.trees[1] = moving;
    out.tree_count = scene.moving.triangle_count() > 0 ? 2 : 1;
    out.light_lists = uploads_.push(is_latest ? lights->lists() : scene.kept_lights.lists);
    out.static_light_indices = gpu_world->light_indices.address();
    out.dynamic_light_indices
        = uploads_.push(is_latest ? lights->dynamic_indices() : scene.kept_lights.dynamic_indices);
    out.bsp_tree = gpu_world->bsp_tree.address();
    out.light_list_count = uint32_t(lights->lists().size());
}

// What moves, right into the memory that the device reads.
shared::BvhView Frame::write_moving(const MovingGeometry& moving, MovingTarget target)
{
    const CpuTimer timer("cpu bvh");
    const Upload nodes = uploads_.reserve(moving.node_count() * shared::BVH_NODE_BYTES);
    // One record even where there is none: its address must be one.
    const Upload records = uploads_.reserve(std::max<size_t>(moving.triangle_count(), 1) * shared::BVH_TRIANGLE_BYTES);
    target.nodes = nodes.as<uint32_t>();
    target.records = records.as<uint32_t>();
    const Grid grid = moving_writer_.write(moving, target);
    return { nodes.address, records.address, grid.origin, grid.scale };
}

void Frame::fill_structures(
    shared::SceneView& out, const SceneSnapshot& scene, const GpuWorld* gpu_world, const MovingTarget& target)
{
    const CpuTimer timer("cpu bvh");
    // Only Mesa's CPU driver depends on the order, and sorting costs time every frame.
    const bool sorts = graphics_.device.is_cpu;
    const bool has_world = scene.world && gpu_world;
    if (has_world && !structures_.holds_world(gpu_world->version)) {
        const MapGeometry& map = scene.world->models[0];
        structures_.build_world(group_triangles({ map.triangles, map.masks, map.has_holes, 0 },
                                    sorts ? TriangleOrder::halves_best : TriangleOrder::as_given),
            gpu_world->version, graphics_.uploader);
    }
    // Read again here, for which memory of the device is slow.
    std::vector<shared::Triangle> triangles(scene.moving.triangle_count());
    std::vector<uint32_t> masks(triangles.size());
    MovingTarget staging { triangles.data(), masks.data() };
    staging.previous_positions = target.previous_positions;
    moving_writer_.write(scene.moving, staging);
    std::ranges::copy(triangles, target.triangles);
    std::vector<uint8_t> has_holes(triangles.size());
    for (size_t i = 0; i < has_holes.size(); i++)
        has_holes[i] = (scene.materials[triangles[i].material].flags & shared::MATERIAL_ALPHA_TEST) != 0;
    const GroupedTriangles moving = group_triangles({ triangles, masks, has_holes, scene.moving.first_id() },
        sorts ? TriangleOrder::halves_quick : TriangleOrder::as_given);
    const AccelerationStructures::View view = structures_.record_view(commands_, moving, has_world);
    out.structure = view.structure;
    out.structure_ids[0] = view.ids[0];
    out.structure_ids[1] = view.ids[1];
}

double Frame::bytes_per_triangle(const GpuWorld& gpu_world, const World& world) const
{
    if (backend_ != TraceBackend::software)
        return structures_.world_bytes_per_triangle();
    const size_t count = world.models[0].triangles.size();
    return count > 0 ? double(gpu_world.bvh_nodes.size() + gpu_world.bvh_triangles.size()) / double(count) : 0;
}

uint32_t Frame::write_uniforms(const shared::FrameUniforms& uniforms)
{
    const uint32_t offset = uint32_t(uniform_stride_) * (graphics_.slot() * max_views + views_this_frame_++);
    std::memcpy(uniforms_.mapped() + offset, &uniforms, sizeof(uniforms));
    return offset;
}

void Frame::bind(uint32_t uniform_offset) const
{
    graphics_.bindings.bind(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, uniform_offset);
    if (backend_ == TraceBackend::pipeline)
        graphics_.bindings.bind(commands_, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, uniform_offset);
}

// What one pass wrote, the next one reads.
void Frame::finish_pass(const char* name)
{
    const VkPipelineStageFlags shaders = graphics_.device.shader_stages();
    record_memory_barrier(commands_, shaders, VK_ACCESS_SHADER_WRITE_BIT, shaders, shader_access);
    graphics_.timer.mark(commands_, name);
}

void Frame::record_pass(const char* name, uint32_t groups)
{
    vkCmdBindPipeline(
        commands_, VK_PIPELINE_BIND_POINT_COMPUTE, graphics_.pipelines.compute(std::string(name) + ".comp"));
    vkCmdDispatch(commands_, groups, 1, 1);
    finish_pass(name);
}

// A pass that traces: its shader was built once for each backend.
void Frame::record_traced_pass(const char* name, const Work& work)
{
    record_traced(name, traced_shader(name, backend_), work);
}

// A pass that chooses lights, and traces: its shader was built once for each light sampler, too.
void Frame::record_lit_pass(const char* name, const Work& work)
{
    record_traced(name, lit_shader(name, backend_), work);
}

void Frame::record_traced(const char* name, const std::string& shader, const Work& work)
{
    if (backend_ == TraceBackend::pipeline) {
        const RayPipeline& pipeline = graphics_.pipelines.ray(shader);
        vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline.handle);
        vkCmdTraceRaysKHR(commands_, &pipeline.generation, &pipeline.miss, &pipeline.hit, &pipeline.callable,
            work.launch.x, work.launch.y, 1);
    } else {
        vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, graphics_.pipelines.compute(shader));
        vkCmdDispatch(commands_, work.groups, 1, 1);
    }
    finish_pass(name);
}

// The whole image pipeline. A pass is its shader's name; what it reads and writes is in shared/screen_buffers.def.
void Frame::record_passes(const shared::FrameUniforms& uniforms, Surfaces surfaces, bool world)
{
    const Work pixels = pixel_work(uniforms.size);
    if (surfaces == Surfaces::camera)
        record_traced_pass("primary_visibility", pixels);
    else
        record_pass("probe_surfaces", pixels.groups);
    record_replay(uniforms);
    record_lit_pass("direct_light", pixels);
    record_lit_pass("indirect_light", pixels); // also without bounces: MIS samplers need its rays
    if (uniforms.flags & shared::FRAME_DENOISED)
        record_denoiser(uniforms);
    record_pass("accumulate", pixels.groups);
    if (uniforms.flags & shared::FRAME_ANTIALIASED)
        record_pass("temporal_antialiasing", pixel_groups(uniforms.resolved_size));
    if (surfaces == Surfaces::probes)
        return;
    if (world)
        record_lit_pass("light_level", { 1, { shared::LIGHT_LEVEL_LANES, 1 } });
    record_pass("exposure", 1);
    if (uniforms.flags & shared::FRAME_BLOOM)
        record_bloom(uniforms);
    record_pass("tone_map", pixel_groups(uniforms.output_size));
}

// What was averaged holds no longer if anything has changed.
void Frame::follow_changes(const View& view, bool average)
{
    CvarValues shown_by = cvars::values();
    shown_by.r_lightlevel = 0; // written by ourselves, every frame
    if (!average || !is_same(view, last_view_) || !(shown_by == last_cvars_))
        restart_accumulation();
    last_view_ = view;
    last_cvars_ = shown_by;
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
        engine::print("vkpt: more than {} 3D views in one frame; the rest is not shown", max_views);
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
    view_size_ = uniforms.resolved_size;
    radiance_ = scene.world ? &graphics_.screen.accumulated() : &graphics_.screen.radiance();
    fill_scene(
        uniforms.scene, scene, gpu_world, uniforms.flags & shared::FRAME_HISTORY ? Motion::known : Motion::unknown);
    if (scene.world) {
        rendered_size_ = size;
        uniforms.scene.oldest_repeatable = is_followed_by_another_ ? uniforms.frame_index
            : lists_changed_                                       ? history_frame_index_
                                                                   : 0;
        is_followed_by_another_ = false;
        lists_changed_ = scene.world->light_lists.has_changed();
        history_frame_index_ = uniforms.frame_index;
    }
    uniforms.time = scene.time;
    uniforms.flags |= (scene.has_alpha_test ? shared::FRAME_ALPHA_TEST : 0) | (scene.world ? 0 : shared::FRAME_NO_WORLD)
        | (average ? shared::FRAME_JITTER : 0)
        | (!average && scene.world && wants_bloom(uniforms) ? shared::FRAME_BLOOM : 0);
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
    record_passes(uniforms, Surfaces::camera, scene.world != nullptr);
    if (counts_rays)
        record_read_ray_counts();
    record_memory_barrier(
        commands_, shaders, VK_ACCESS_SHADER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    if (scene.world)
        accumulated_frames_++;
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
    const size_t bytes = size_t(view_size_.x) * view_size_.y * sizeof(glm::vec3);
    if (bytes == 0 || !radiance_)
        return false;
    const Buffer copy(graphics_.gpu, bytes, BufferHome::readback, MemoryKind::staging, "radiance readback");
    graphics_.run_once([&](VkCommandBuffer commands) {
        record_memory_barrier(commands, graphics_.device.shader_stages(), VK_ACCESS_SHADER_WRITE_BIT,
            VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
        const VkBufferCopy region { 0, 0, bytes };
        vkCmdCopyBuffer(commands, radiance_->handle(), copy.handle(), 1, &region);
        record_memory_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
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
    history_.forget();
    view_size_ = view.size;
    radiance_ = &graphics_.screen.accumulated();
    for (uint32_t sample = 0; sample < samples; sample++) {
        accumulated_frames_ = sample;
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
            graphics_.timer.begin_frame(commands, graphics_.slot());
            record_passes(uniforms, Surfaces::probes, true);
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
    static_assert(sizeof(TracedRay) == 8 * sizeof(float) && sizeof(TracedHit) == 5 * sizeof(float));
    const Buffer result(
        graphics_.gpu, rays.size() * sizeof(TracedHit), BufferHome::readback, MemoryKind::staging, "traced hits");
    View view;
    view.size = { row, (uint32_t(rays.size()) + row - 1) / row };
    graphics_.finish();
    reserve(view.size);
    history_.forget();
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
            graphics_.timer.begin_frame(commands, graphics_.slot());
            bind(offset);
            for (uint32_t round = 0; round < rounds; round++)
                record_traced_pass("probe_rays", pixel_work(view.size));
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
