// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/moving_geometry.hpp"

#include "ref_vkpt/rays/bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace vkpt {

namespace {

using shared::Triangle;

constexpr uint32_t max_ids = 1u << 24;
static_assert(shared::BVH_ID_MASK == max_ids - 1);

// A triangle of the tree, see bvh.cpp.
struct Record {
    glm::vec3 positions[3];
    uint32_t id_and_mask;
    uint32_t padding[2] {};
};
static_assert(sizeof(Record) == shared::BVH_TRIANGLE_BYTES);

uint32_t id_and_mask(uint32_t id, uint32_t mask) { return id | mask << shared::BVH_RAY_MASK_SHIFT; }

// Where one mesh's triangles go; records may be nullptr.
struct MeshTarget {
    Triangle* triangles;
    uint32_t* records;
    uint32_t first_id;
};

void write_record(uint32_t* records, uint32_t slot, const Triangle& triangle, uint32_t id, uint32_t mask)
{
    const Record record { { triangle.positions[0], triangle.positions[1], triangle.positions[2] },
        id_and_mask(id, mask), {} };
    std::memcpy(records + size_t(slot) * bvh_triangle_words, &record, sizeof record);
}

// Three positions at `target`, a register at a time, so that four bytes behind them are spoilt: write what follows
// afterwards.
void write_corners(void* target, const Float4& a, const Float4& b, const Float4& c)
{
    auto* bytes = static_cast<std::byte*>(target);
    std::memcpy(bytes, &a, sizeof a);
    std::memcpy(bytes + sizeof(glm::vec3), &b, sizeof b);
    std::memcpy(bytes + 2 * sizeof(glm::vec3), &c, sizeof c);
}

uint32_t normal_of(const Float4& point) { return std::bit_cast<std::array<uint32_t, 4>>(point)[3]; }

void write_md2(const Md2Mesh& mesh, const std::vector<Float4>& points, bool mirrored, uint32_t material, uint32_t mask,
    const MeshTarget& target)
{
    // What is mirrored turns its corners around, so that its front stays outside.
    const size_t second = mirrored ? 2 : 1, third = 3 - second;
    for (uint32_t slot = 0; slot < mesh.triangle_count(); slot++) {
        const uint32_t* corners = &mesh.corners()[size_t(slot) * 3];
        const Float4 a = points[corners[0]], b = points[corners[second]], c = points[corners[third]];
        const auto& uvs = mesh.uvs()[slot];
        Triangle& triangle = target.triangles[slot];
        write_corners(triangle.positions, a, b, c);
        triangle.uvs[0] = uvs[0];
        triangle.uvs[1] = uvs[second];
        triangle.uvs[2] = uvs[third];
        triangle.normals[0] = normal_of(a);
        triangle.normals[1] = normal_of(b);
        triangle.normals[2] = normal_of(c);
        triangle.material = material;
        triangle.emitter = triangle.cluster = -1;
        triangle.lightstyle = 0; // the memory is the device's: nothing in it is zero by itself
        triangle.face = 0;
        if (target.records) {
            uint32_t* record = target.records + size_t(slot) * bvh_triangle_words;
            write_corners(record, a, b, c);
            record[offsetof(Record, id_and_mask) / sizeof *record] = id_and_mask(target.first_id + slot, mask);
        }
    }
}

// Turns the normals of faces, whose corners mostly share one.
void turn_normals(uint32_t (&normals)[3], const Transform& transform)
{
    const uint32_t before[3] = { normals[0], normals[1], normals[2] };
    for (int i = 0; i < 3; i++)
        normals[i] = i > 0 && before[i] == before[i - 1]
            ? normals[i - 1]
            : encode_octahedral(transform.direction(decode_octahedral(before[i])));
}

struct BrushLook {
    const uint32_t* materials;
    int first_emitter;
    uint32_t mask; // 0: each triangle its own
    const MovingGeometry& geometry;
};

void write_brush(const BrushMesh& mesh, const std::vector<Float4>& points, const Transform& transform,
    const BrushLook& look, const MeshTarget& target)
{
    const bool turned = transform.rotation != glm::mat3(1);
    for (uint32_t slot = 0; slot < mesh.triangles.size(); slot++) {
        Triangle triangle = mesh.triangles[slot];
        for (uint32_t i = 0; i < 3; i++)
            triangle.positions[i] = to_vec3(points[slot * 3 + i]);
        if (turned)
            turn_normals(triangle.normals, transform);
        triangle.material = look.materials[triangle.material];
        if (triangle.emitter >= 0)
            triangle.emitter = look.first_emitter >= 0 ? look.geometry.emitter_at(triangle.emitter + look.first_emitter)
                                                       : shared::EMITTER_UNLISTED;
        triangle.cluster = -1;
        target.triangles[slot] = triangle;
        if (target.records)
            write_record(
                target.records, slot, triangle, target.first_id + slot, look.mask ? look.mask : mesh.masks[slot]);
    }
}

} // namespace

// ---- the list

bool MovingGeometry::add(
    std::shared_ptr<const Md2Mesh> mesh, const Md2Pose& pose, uint32_t material, uint32_t mask, const ModelLamps& lamps)
{
    if (!mesh->can_pose(pose))
        return false;
    const Box bounds = mesh->bounds(pose);
    Item item;
    item.md2 = std::move(mesh);
    item.pose = pose;
    item.material = material;
    item.mask = mask;
    item.lamps = lamps.lamps;
    item.first_emitter = lamps.first_emitter;
    return add_item(std::move(item), bounds);
}

bool MovingGeometry::add(const BrushMesh& mesh, const BrushPose& pose)
{
    if (!mesh.usable || !is_sane(pose.transform))
        return false;
    Item item;
    item.brush = &mesh;
    item.transform = pose.transform;
    item.material = uint32_t(brush_materials_.size());
    item.mask = pose.mask;
    item.first_emitter = pose.first_emitter;
    if (!add_item(std::move(item), bounds_of(mesh, pose.transform)))
        return false;
    brush_materials_.insert(brush_materials_.end(), pose.materials.begin(), pose.materials.end());
    return true;
}

bool MovingGeometry::add_item(Item&& item, const Box& bounds)
{
    const MeshTree& tree = item.tree();
    if (tree.slot_count() == 0 || first_id_ + uint64_t(mesh_triangles_) + tree.slot_count() > max_ids)
        return false;
    item.first_slot = mesh_triangles_;
    item.first_node = mesh_nodes_;
    mesh_triangles_ += tree.slot_count();
    mesh_nodes_ += tree.node_count;
    all_have_trees_ &= tree.node_count > 0;
    bounds_.add(bounds);
    items_.push_back(std::move(item));
    return true;
}

void MovingGeometry::keep_previous(size_t first, size_t count, const MovingGeometry& before, size_t first_before)
{
    for (size_t i = 0; i < count && first + i < items_.size() && first_before + i < before.items_.size(); i++) {
        Item& item = items_[first + i];
        const Item& old = before.items_[first_before + i];
        if (item.md2 != old.md2 || item.brush != old.brush)
            continue;
        item.has_previous = true;
        item.previous_pose = old.pose;
        item.previous_transform = old.transform;
    }
}

void MovingGeometry::keep_previous_loose(size_t first, size_t count, const MovingGeometry& before, size_t first_before)
{
    const auto corners = [](const Triangle& triangle) { return std::to_array(triangle.positions); };
    if (previous_loose_.size() != loose_.size()) {
        previous_loose_.resize(loose_.size());
        std::ranges::transform(loose_, previous_loose_.begin(), corners);
    }
    for (size_t i = 0; i < count && first + i < loose_.size() && first_before + i < before.loose_.size(); i++)
        previous_loose_[first + i] = corners(before.loose_[first_before + i]);
}

uint32_t MovingGeometry::loose_count() const
{
    const uint32_t ids_used = std::min(first_id_ + mesh_triangles_, max_ids);
    return uint32_t(std::min<size_t>(loose_.size(), max_ids - ids_used));
}

bool MovingGeometry::has_two_levels() const
{
    return all_have_trees_ && mesh_count() <= max_moving_meshes && loose_count() <= max_mesh_triangles;
}

size_t MovingGeometry::node_count() const
{
    if (!has_two_levels())
        return max_nodes(triangle_count());
    return tlas_node_count(mesh_count()) + mesh_nodes_ + (loose_count() > 0 ? max_nodes(loose_count()) : 0);
}

// ---- the work

void MovingWriter::write(const MovingGeometry& geometry, const MovingTarget& target)
{
    if (target.nodes && !geometry.has_two_levels()) {
        write_one_tree(geometry, target);
        return;
    }
    const uint32_t loose = geometry.loose_count();
    Box bounds = geometry.bounds_;
    for (uint32_t i = 0; i < loose; i++)
        for (const glm::vec3 p : geometry.loose_[i].positions)
            bounds.add(p);
    const Job job { geometry, target, box_margin(bounds) };
    meshes_.resize(geometry.mesh_count());
    // The loose ones first: to order them takes longer than to refit a mesh.
    const size_t loose_jobs = loose > 0 ? 1 : 0;
    workers_.parallel_for(loose_jobs + geometry.items_.size(), [&](size_t i, size_t thread) {
        if (i < loose_jobs)
            write_loose(job);
        else
            write_item(job, i - loose_jobs, scratch_[thread]);
    });
    if (target.nodes)
        write_tlas(meshes_, job.margin, target.place.first_node, target.nodes);
}

void MovingWriter::write_item(const Job& job, size_t index, Scratch& scratch)
{
    const MovingGeometry& geometry = job.geometry;
    const MovingGeometry::Item& item = geometry.items_[index];
    const MeshTree& tree = item.tree();
    if (item.md2)
        item.md2->pose(item.pose, scratch.points);
    else
        pose_points(*item.brush, item.transform, scratch.points);

    const MovingTarget& target = job.target;
    if (target.nodes && tree.node_count > 0) {
        const uint32_t first_node = tlas_node_count(geometry.mesh_count()) + item.first_node;
        const TreePlace place = job.place(first_node, item.first_slot);
        const std::span<const uint32_t> corners = item.md2 ? item.md2->corners() : std::span(item.brush->corners);
        const Box box = refit(tree, corners, scratch.points.data(), job.margin, place,
            target.nodes + size_t(first_node) * bvh_node_words, scratch.boxes);
        meshes_[index] = { box, place.first_node, tree.stack_need };
    }
    const MeshTarget out { target.triangles + item.first_slot,
        target.records ? target.records + size_t(item.first_slot) * bvh_triangle_words : nullptr,
        geometry.first_id_ + item.first_slot };
    if (item.md2) {
        write_md2(*item.md2, scratch.points, item.pose.mirror.has_value(), item.material, item.mask, out);
        for (size_t i = 0; item.lamps && i < item.lamps->size(); i++)
            out.triangles[(*item.lamps)[i].slot].emitter = geometry.emitter_at(item.first_emitter + int(i));
    } else {
        write_brush(*item.brush, scratch.points, item.transform,
            { &geometry.brush_materials_[item.material], item.first_emitter, item.mask, geometry }, out);
    }
    if (target.previous_positions)
        write_previous(item, scratch, target.previous_positions + item.first_slot);
    if (target.masks && item.brush && item.mask == 0)
        std::ranges::copy(item.brush->masks, target.masks + item.first_slot);
    else if (target.masks)
        std::fill_n(target.masks + item.first_slot, tree.slot_count(), item.mask);
}

// After the item has been posed: scratch.points.
void MovingWriter::write_previous(
    const MovingGeometry::Item& item, Scratch& scratch, std::array<glm::vec3, 3>* positions)
{
    const bool stands = !item.has_previous || (item.brush && item.previous_transform == item.transform);
    const std::vector<Float4>& points = stands ? scratch.points : scratch.previous_points;
    if (!stands && item.md2)
        item.md2->pose(item.previous_pose, scratch.previous_points);
    else if (!stands)
        pose_points(*item.brush, item.previous_transform, scratch.previous_points);
    const std::span<const uint32_t> corners = item.md2 ? item.md2->corners() : std::span(item.brush->corners);
    // As write_md2() turns them.
    const size_t second = item.md2 && item.pose.mirror ? 2 : 1, third = 3 - second;
    for (size_t slot = 0; slot * 3 < corners.size(); slot++) {
        const uint32_t* at = &corners[slot * 3];
        positions[slot] = { to_vec3(points[at[0]]), to_vec3(points[at[second]]), to_vec3(points[at[third]]) };
    }
}

void MovingWriter::write_loose(const Job& job)
{
    const MovingGeometry& geometry = job.geometry;
    const MovingTarget& target = job.target;
    const uint32_t count = geometry.loose_count(), first_slot = geometry.mesh_triangles_;
    std::copy_n(geometry.loose_.begin(), count, target.triangles + first_slot);
    if (target.masks)
        std::copy_n(geometry.loose_masks_.begin(), count, target.masks + first_slot);
    if (target.previous_positions && geometry.previous_loose_.size() >= count)
        std::copy_n(geometry.previous_loose_.begin(), count, target.previous_positions + first_slot);
    else if (target.previous_positions)
        for (uint32_t i = 0; i < count; i++)
            target.previous_positions[first_slot + i] = std::to_array(geometry.loose_[i].positions);
    if (!target.nodes)
        return;
    std::vector<Box> boxes(count);
    for (uint32_t i = 0; i < count; i++)
        for (const glm::vec3 p : geometry.loose_[i].positions)
            boxes[i].add(p);
    BinaryTree binary = build_lbvh(boxes, shared::BVH_MAX_LEAF_TRIANGLES);
    const WideTree wide = make_wide(binary, boxes, shared::BVH_MAX_LEAF_TRIANGLES, mesh_stack_budget);
    const uint32_t first_node = tlas_node_count(geometry.mesh_count()) + geometry.mesh_nodes_;
    const TreePlace place = job.place(first_node, first_slot);
    write_mesh(wide, job.margin, place, target.nodes + size_t(first_node) * bvh_node_words);
    for (uint32_t slot = 0; slot < count; slot++) {
        const uint32_t i = binary.order[slot];
        write_record(target.records, first_slot + slot, geometry.loose_[i], geometry.first_id_ + first_slot + i,
            geometry.loose_masks_[i]);
    }
    meshes_.back() = { binary.nodes[0].box, place.first_node, wide.stack_need };
}

void MovingWriter::write_one_tree(const MovingGeometry& geometry, const MovingTarget& target)
{
    // Not from the target: memory of a device is slow to read.
    std::vector<Triangle> triangles(geometry.triangle_count());
    std::vector<uint32_t> masks(geometry.triangle_count());
    MovingTarget staging { triangles.data(), masks.data() };
    staging.previous_positions = target.previous_positions;
    write(geometry, staging);
    std::vector<BvhTriangle> sources(triangles.size());
    for (size_t i = 0; i < sources.size(); i++) {
        std::ranges::copy(triangles[i].positions, sources[i].positions);
        sources[i].id = geometry.first_id_ + uint32_t(i);
        sources[i].mask = masks[i];
    }
    Bvh bvh = build_bvh(sources, BvhQuality::fast);
    place_nodes(bvh.nodes, target.place);
    std::ranges::copy(triangles, target.triangles);
    if (target.masks)
        std::ranges::copy(masks, target.masks);
    std::ranges::copy(bvh.nodes, target.nodes);
    if (bvh.triangle_count > 0)
        std::ranges::copy(bvh.triangles, target.records);
}

} // namespace vkpt
