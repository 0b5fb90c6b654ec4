// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/scene_upload.hpp"

#include "ref_vkpt/pass_statistics.hpp"
#include "ref_vkpt/rays/wide_tree.hpp"

#include <algorithm>
#include <array>

namespace vkpt {

namespace {

// What a map's data looks like to the shaders where there is no map: one list with every emitter.
struct NoWorld {
    std::vector<shared::LightList> lists;
    std::array<uint32_t, 16> empty_entry {}; // of any sampler's table
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

// What of the emitters and triangles stays the same from frame to frame.
struct FixedPart {
    const std::vector<shared::Emitter>& emitters;
    const std::vector<shared::Triangle>& triangles;
};

FixedPart fixed_part(const SceneSnapshot& scene)
{
    static const std::vector<shared::Emitter> no_emitters;
    static const std::vector<shared::Triangle> no_triangles;
    if (!scene.world)
        return { no_emitters, no_triangles };
    if (scene.shown_lights)
        return { scene.shown_lights->emitters, scene.shown_lights->triangles };
    return { scene.world->models[0].emitters, scene.world->models[0].triangles };
}

// Another number for every map, and whenever lights of it are muted.
uint64_t version_of_lights(const SceneSnapshot& scene, uint64_t map_version)
{
    return scene.shown_lights ? map_version + (uint64_t(scene.shown_lights->version) << 32) : map_version;
}

} // namespace

SceneUpload::Kept::Kept(const Gpu& gpu, const Bindings& bindings)
    : texels(gpu, bindings)
    , triangles(gpu, MemoryKind::geometry, "triangles")
    , emitters(gpu, MemoryKind::lights, "emitters")
    , tree_nodes(gpu, MemoryKind::acceleration, "BVH nodes")
    , tree_triangles(gpu, MemoryKind::acceleration, "BVH triangles")
    , packed_lights(gpu)
    , materials(gpu, MemoryKind::geometry, "materials")
    , light_lists(gpu, MemoryKind::lights, "light list headers")
    , dynamic_light_indices(gpu, MemoryKind::lights, "dynamic light indices")
{
}

SceneUpload::SceneUpload(Graphics& graphics, Workers& workers)
    : graphics_(graphics)
    , uploads_(graphics.gpu, MemoryKind::staging)
    , moving_writer_(workers)
    , structures_(graphics.gpu)
{
}

void SceneUpload::begin_frame()
{
    uploads_.begin_frame(graphics_.slot());
    structures_.begin_frame(graphics_.slot());
}

VkDescriptorSet SceneUpload::fill(
    shared::SceneView& out, const SceneSnapshot& scene, const GpuWorld* gpu_world, const Use& use)
{
    const CpuTimer timer("cpu upload");
    const uint32_t slot = graphics_.slot();
    while (kept_.size() <= use.view_number)
        kept_.emplace_back(graphics_.gpu, graphics_.bindings);
    const Job job { out, scene, gpu_world, use, kept_[use.view_number], gpu_world ? gpu_world->version : UINT64_MAX };
    MovingTarget target = reserve_moving(job);
    fill_emitters(job);
    out.materials = job.kept.materials.write(slot, scene.materials);
    out.trace_stack = use.trace_stack;
    out.sky = scene.sky;
    if (use.backend == TraceBackend::software)
        write_trees(job, target);
    else
        write_structures(job, target);
    if (graphics_.device.reads_texels())
        bind_texels(job);
    fill_light_lists(job);
    if (!graphics_.device.maps_all_memory)
        record_copies(job);
    return job.kept.texels.set(slot);
}

void SceneUpload::record_copies(const Job& job)
{
    for (PrefixedUpload* upload :
        { &job.kept.triangles, &job.kept.emitters, &job.kept.tree_nodes, &job.kept.tree_triangles })
        upload->record_copies(job.use.commands, graphics_.slot());
    record_memory_barrier(job.use.commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
        graphics_.device.shader_stages(), VK_ACCESS_SHADER_READ_BIT);
}

// The map's triangles, and room for what moves.
MovingTarget SceneUpload::reserve_moving(const Job& job)
{
    const MovingGeometry& moving = job.scene.moving;
    const Upload triangles = job.kept.triangles.reserve(graphics_.slot(), fixed_part(job.scene).triangles,
        version_of_lights(job.scene, job.version), moving.triangle_count());
    job.out.triangles = triangles.address;
    job.out.first_moving = UINT32_MAX;
    MovingTarget target;
    target.triangles = triangles.as<shared::Triangle>();
    if (job.use.finds_reprojected && moving.triangle_count() > 0) {
        using Corners = std::array<glm::vec3, 3>;
        const Upload previous = uploads_.reserve(moving.triangle_count() * sizeof(Corners));
        target.previous_positions = previous.as<Corners>();
        job.out.previous_positions = previous.address;
        job.out.first_moving = moving.first_id();
    }
    return target;
}

void SceneUpload::fill_emitters(const Job& job)
{
    const SceneSnapshot& scene = job.scene;
    const uint64_t version = version_of_lights(scene, job.version);
    const uint32_t slot = graphics_.slot();
    const LightLists* lights = scene.world ? scene.light_lists : nullptr;
    const bool repeats = lights && lights->has_changed() && job.use.finds_reprojected;
    const LightLists::Repeated repeated = repeats ? lights->repeat() : LightLists::Repeated();
    // Lights that have gone stay in the repeated lists: dark.
    const size_t count = std::max(
        scene.emitters.size(), repeats ? repeated.emitter_count - lights->static_emitter_count() : size_t(0));
    const std::vector<shared::Emitter>& fixed = fixed_part(scene).emitters;
    const Upload emitters = job.kept.emitters.reserve(slot, fixed, version, count);
    auto* const end = std::ranges::copy(scene.emitters, emitters.as<shared::Emitter>()).out;
    std::fill(end, emitters.as<shared::Emitter>() + count, shared::Emitter {});
    if (repeats) {
        job.out.repeated_lists = uploads_.push(repeated.lists);
        job.out.repeated_light_indices = uploads_.push(repeated.dynamic_indices);
        job.out.previous_list_lengths = uploads_.push(lights->previous_lengths());
    }
    job.out.emitters = emitters.address;
    job.out.lightstyles = uploads_.push(scene.lightstyles);
    job.out.packed_lights
        = job.kept.packed_lights.write(slot, fixed, version, scene.emitters, count, scene.lightstyles);
}

void SceneUpload::bind_texels(const Job& job)
{
    const uint32_t slot = graphics_.slot();
    SceneTexels::Tables tables {};
    if (job.use.backend == TraceBackend::software) {
        tables[shared::TEXELS_TREE_NODES] = &job.kept.tree_nodes.buffer(slot);
        tables[shared::TEXELS_TREE_TRIANGLES] = &job.kept.tree_triangles.buffer(slot);
    }
    tables[shared::TEXELS_TRIANGLES] = &job.kept.triangles.buffer(slot);
    tables[shared::TEXELS_MATERIALS] = &job.kept.materials.buffer(slot);
    tables[shared::TEXELS_EMITTERS] = &job.kept.emitters.buffer(slot);
    tables[shared::TEXELS_PACKED_LIGHTS] = &job.kept.packed_lights.buffer(slot);
    if (job.gpu_world)
        tables[shared::TEXELS_STATIC_LIGHTS] = &job.gpu_world->light_indices;
    job.kept.texels.bind(slot, tables);
}

void SceneUpload::fill_light_lists(const Job& job)
{
    shared::SceneView& out = job.out;
    if (!job.scene.world) {
        const NoWorld none = make_no_world(job.scene.emitters.size());
        out.light_lists = uploads_.push(none.lists);
        out.static_light_indices = out.dynamic_light_indices = uploads_.push(none.indices);
        const uint64_t empty = uploads_.push(std::as_bytes(std::span(none.empty_entry)));
        out.sampler_tables = {
#define VKPT_SAMPLER_TABLE(name, type, alignment) empty,
#include "shaders/shared/sampler_tables.def"
        };
        out.bsp_tree = uploads_.push(none.tree);
        out.light_list_count = 1;
        return;
    }
    const GpuWorld& world = *job.gpu_world;
    const LightLists& lights = *job.scene.light_lists;
    out.static_light_indices = world.light_indices.address();
    out.sampler_tables = world.sampler_tables();
    out.light_tree_lights = world.light_tree_lights;
    out.light_lists = job.kept.light_lists.write(graphics_.slot(), lights.lists());
    out.dynamic_light_indices = job.kept.dynamic_light_indices.write(graphics_.slot(), lights.dynamic_indices());
    out.bsp_tree = world.bsp_tree.address();
    out.lightmap_faces = world.lightmap_faces.address();
    out.luxels = world.luxels.address();
    out.cache = world.light_cache.addresses();
    out.light_list_count = uint32_t(lights.lists().size());
}

// What moves goes right into the memory that the device reads.
void SceneUpload::write_trees(const Job& job, MovingTarget target)
{
    const CpuTimer timer("cpu bvh");
    const MovingGeometry& moving = job.scene.moving;
    const WorldTrees* world = job.scene.world ? &job.scene.world->trees() : nullptr;
    // One record even where there is none: its address must be one.
    const size_t record_count = std::max<size_t>(moving.triangle_count(), 1);
    // The map's tree and the moving things' stand one behind the other, so that a ray searches both in one go.
    static const Bvh nothing;
    const Bvh& front = world ? world->bvh : nothing;
    const Upload nodes
        = job.kept.tree_nodes.reserve(graphics_.slot(), front.nodes, job.version, moving.node_count() * bvh_node_words);
    const Upload records = job.kept.tree_triangles.reserve(
        graphics_.slot(), front.triangles, job.version, record_count * bvh_triangle_words);
    target.nodes = nodes.as<uint32_t>();
    target.records = records.as<uint32_t>();
    target.place
        = { uint32_t(front.nodes.size() / bvh_node_words), uint32_t(front.triangles.size() / bvh_triangle_words) };
    moving_writer_.write(moving, target);
    const bool searches_moving = world && moving.triangle_count() > 0;
    job.out.trees
        = { nodes.address, records.address, 0, searches_moving ? target.place.first_node : shared::BVH_NO_CHILD };
    job.out.filter_root = world ? world->filter_root : shared::BVH_NO_CHILD;
    job.out.other_filter_root = job.scene.filter_boxes.empty() ? shared::BVH_NO_CHILD : job.out.trees.other_root;
}

void SceneUpload::write_structures(const Job& job, const MovingTarget& target)
{
    const SceneSnapshot& scene = job.scene;
    const CpuTimer timer("cpu bvh");
    const bool sorts = graphics_.device.traits.sorts_triangles;
    const bool has_world = scene.world && job.gpu_world;
    if (has_world && !structures_.holds_world(job.gpu_world->version)) {
        const MapGeometry& map = scene.world->models[0];
        structures_.build_world(group_triangles({ map.triangles, map.masks, map.has_holes, 0 },
                                    sorts ? TriangleOrder::halves_best : TriangleOrder::as_given),
            job.gpu_world->version, graphics_.uploader);
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
    const bool in_frame = job.use.commands == graphics_.commands(); // else they are no part of the frame's time
    if (in_frame)
        graphics_.timer.mark(job.use.commands, "2d");
    const AccelerationStructures::View view = structures_.record_view(job.use.commands, moving, has_world);
    if (in_frame)
        graphics_.timer.mark(job.use.commands, "acceleration_structures");
    job.out.structure = view.structure;
    job.out.structure_ids[0] = view.ids[0];
    job.out.structure_ids[1] = view.ids[1];
}

double SceneUpload::bytes_per_triangle(const World& world, TraceBackend backend) const
{
    if (backend != TraceBackend::software)
        return structures_.world_bytes_per_triangle();
    const size_t count = world.models[0].triangles.size();
    const Bvh& bvh = world.trees().bvh;
    return count > 0 ? double((bvh.nodes.size() + bvh.triangles.size()) * sizeof(uint32_t)) / double(count) : 0;
}

} // namespace vkpt
