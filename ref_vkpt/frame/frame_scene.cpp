// SPDX-License-Identifier: GPL-2.0-or-later
// The part of the frame that brings the scene to the device: triangles, trees, emitters, light lists.
#include "ref_vkpt/frame/frame.hpp"

#include "ref_vkpt/trace/wide_tree.hpp"

#include <algorithm>
#include <array>

namespace vkpt {

namespace {

// What a map's data looks like to the shaders where there is no map: one list with every emitter.
struct NoWorld {
    std::vector<shared::LightList> lists;
    std::vector<shared::LightMultiset> multisets { {} };
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

Frame::SceneUploads::SceneUploads(const Gpu& gpu, const Bindings& bindings)
    : texels(std::make_unique<SceneTexels>(gpu, bindings))
    , triangles(gpu, MemoryKind::geometry, "triangles")
    , emitters(gpu, MemoryKind::lights, "emitters")
    , tree_nodes(gpu, MemoryKind::acceleration, "BVH nodes")
    , tree_triangles(gpu, MemoryKind::acceleration, "BVH triangles")
    , outlines(gpu)
    , materials(gpu, MemoryKind::geometry, "materials")
    , light_lists(gpu, MemoryKind::lights, "light list headers")
    , dynamic_light_indices(gpu, MemoryKind::lights, "dynamic light indices")
{
}

void Frame::fill_scene(shared::SceneView& out, SceneSnapshot& scene, const GpuWorld* gpu_world, Motion motion)
{
    const CpuTimer timer("cpu upload");
    static const std::vector<shared::Triangle> no_triangles;
    static const std::vector<shared::Emitter> no_emitters;
    const uint32_t slot = graphics_.slot();
    const MapGeometry* world = scene.world ? &scene.world->models[0] : nullptr;
    while (scene_uploads_.size() <= views_this_frame_)
        scene_uploads_.emplace_back(graphics_.gpu, graphics_.bindings);
    SceneUploads& kept = scene_uploads_[views_this_frame_];
    const uint64_t version = gpu_world ? gpu_world->version : UINT64_MAX;
    const Upload triangles
        = kept.triangles.reserve(slot, world ? world->triangles : no_triangles, version, scene.moving.triangle_count());
    const LightLists* lights = world ? &scene.world->light_lists : nullptr;
    const bool repeats = lights && lights->has_changed() && motion == Motion::known;
    const LightLists::Repeated repeated = repeats ? lights->repeat() : LightLists::Repeated();
    // Lights that have gone stay in the repeated lists: dark.
    const size_t emitter_count = std::max(
        scene.emitters.size(), repeats ? repeated.emitter_count - lights->static_emitter_count() : size_t(0));
    const std::vector<shared::Emitter>& fixed_emitters = world ? world->emitters : no_emitters;
    const Upload emitters = kept.emitters.reserve(slot, fixed_emitters, version, emitter_count);
    auto* const end = std::ranges::copy(scene.emitters, emitters.as<shared::Emitter>()).out;
    std::fill(end, emitters.as<shared::Emitter>() + emitter_count, shared::Emitter {});
    if (repeats) {
        out.repeated_lists = uploads_.push(repeated.lists);
        out.repeated_light_indices = uploads_.push(repeated.dynamic_indices);
        out.previous_list_lengths = uploads_.push(lights->previous_lengths());
    }
    out.triangles = triangles.address;
    out.emitters = emitters.address;
    out.materials = kept.materials.write(slot, scene.materials);
    out.lightstyles = uploads_.push(scene.lightstyles);
    out.emitter_outlines
        = kept.outlines.write(slot, fixed_emitters, version, scene.emitters, emitter_count, scene.lightstyles);
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
    if (backend_ == TraceBackend::software)
        write_trees(out, scene, gpu_world, target);
    else
        fill_structures(out, scene, gpu_world, target);
    scene_texels_ = kept.texels->set(slot);
    if (graphics_.device.reads_texels()) {
        SceneTexels::Tables tables {};
        if (backend_ == TraceBackend::software) {
            tables[shared::TEXELS_TREE_NODES] = &kept.tree_nodes.buffer(slot);
            tables[shared::TEXELS_TREE_TRIANGLES] = &kept.tree_triangles.buffer(slot);
        }
        tables[shared::TEXELS_TRIANGLES] = &kept.triangles.buffer(slot);
        tables[shared::TEXELS_MATERIALS] = &kept.materials.buffer(slot);
        tables[shared::TEXELS_EMITTERS] = &kept.emitters.buffer(slot);
        tables[shared::TEXELS_OUTLINES] = &kept.outlines.buffer(slot);
        if (gpu_world)
            tables[shared::TEXELS_STATIC_LIGHTS] = &gpu_world->light_indices;
        kept.texels->bind(slot, tables);
    }

    if (!world) {
        const NoWorld none = make_no_world(scene.emitters.size());
        out.light_lists = uploads_.push(none.lists);
        out.static_light_indices = out.dynamic_light_indices = uploads_.push(none.indices);
        out.light_multisets = uploads_.push(none.multisets);
        out.bsp_tree = uploads_.push(none.tree);
        out.light_list_count = 1;
        return;
    }
    out.static_light_indices = gpu_world->light_indices.address();
    out.light_multisets = gpu_world->light_multisets.address();
    out.light_tree_roots = gpu_world->light_tree_roots.address();
    out.light_tree_places = gpu_world->light_tree_places.address();
    out.light_tree_lights = gpu_world->light_tree_lights;
    out.light_trees = gpu_world->light_trees.address();
    if (scene.kept_lights.lists.empty()) {
        out.light_lists = kept.light_lists.write(slot, lights->lists());
        out.dynamic_light_indices = kept.dynamic_light_indices.write(slot, lights->dynamic_indices());
    } else {
        out.light_lists = uploads_.push(scene.kept_lights.lists);
        out.dynamic_light_indices = uploads_.push(scene.kept_lights.dynamic_indices);
    }
    out.bsp_tree = gpu_world->bsp_tree.address();
    out.light_list_count = uint32_t(lights->lists().size());
}

// What moves goes right into the memory that the device reads.
void Frame::write_trees(
    shared::SceneView& out, const SceneSnapshot& scene, const GpuWorld* gpu_world, MovingTarget target)
{
    const CpuTimer timer("cpu bvh");
    const MovingGeometry& moving = scene.moving;
    const Bvh* world = scene.world ? &scene.world->bvh() : nullptr;
    // One record even where there is none: its address must be one.
    const size_t record_count = std::max<size_t>(moving.triangle_count(), 1);
    // The map's tree and the moving things' stand one behind the other, so that a ray searches both in one go.
    static const Bvh nothing;
    const Bvh& front = world ? *world : nothing;
    SceneUploads& kept = scene_uploads_[views_this_frame_];
    const uint64_t version = gpu_world ? gpu_world->version : UINT64_MAX;
    const Upload nodes
        = kept.tree_nodes.reserve(graphics_.slot(), front.nodes, version, moving.node_count() * bvh_node_words);
    const Upload records
        = kept.tree_triangles.reserve(graphics_.slot(), front.triangles, version, record_count * bvh_triangle_words);
    target.nodes = nodes.as<uint32_t>();
    target.records = records.as<uint32_t>();
    target.place
        = { uint32_t(front.nodes.size() / bvh_node_words), uint32_t(front.triangles.size() / bvh_triangle_words) };
    moving_writer_.write(moving, target);
    const bool searches_moving = world && moving.triangle_count() > 0;
    out.trees = { nodes.address, records.address, 0, searches_moving ? target.place.first_node : shared::BVH_NO_CHILD };
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

double Frame::bytes_per_triangle(const World& world) const
{
    if (backend_ != TraceBackend::software)
        return structures_.world_bytes_per_triangle();
    const size_t count = world.models[0].triangles.size();
    const Bvh& bvh = world.bvh();
    return count > 0 ? double((bvh.nodes.size() + bvh.triangles.size()) * sizeof(uint32_t)) / double(count) : 0;
}

} // namespace vkpt
