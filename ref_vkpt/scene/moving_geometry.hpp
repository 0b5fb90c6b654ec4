// SPDX-License-Identifier: GPL-2.0-or-later
// The triangles of a view that are not the map's. First comes a list: which meshes in which pose, and loose triangles
// (sprites, beams, particles); every entry knows its place in the result. Then MovingWriter makes the triangles and the
// software backend's tree of them, on several threads, right where the device reads them.
#pragma once

#include "ref_vkpt/scene/brush_mesh.hpp"
#include "ref_vkpt/scene/md2_mesh.hpp"
#include "ref_vkpt/scene/skin_lamps.hpp"
#include "ref_vkpt/workers.hpp"

#include <array>
#include <cstdint>
#include <memory>

namespace vkpt {

struct BrushPose {
    Transform transform;
    std::span<const uint32_t> materials; // per BrushMesh::texinfos
    int first_emitter = -1; // added to the triangles' emitters; -1: they emit nothing
    uint32_t mask = 0; // MASK_* for all triangles; 0: each its own
};

// Which triangles of a model are emitters.
struct ModelLamps {
    std::shared_ptr<const SkinLamps> lamps; // nullptr: none
    int first_emitter = -1; // lamp n is emitter first_emitter + n
};

class MovingGeometry {
public:
    // Triangles get the ids `first_id` and up; those that would need 2^24 or more are left out.
    explicit MovingGeometry(uint32_t first_id = 0)
        : first_id_(first_id)
    {
    }

    // What is not finite or lies far outside of any map is left out: false.
    bool add(std::shared_ptr<const Md2Mesh> mesh, const Md2Pose& pose, uint32_t material, uint32_t mask,
        const ModelLamps& lamps = {});
    // `mesh` must outlive this.
    bool add(const BrushMesh& mesh, const BrushPose& pose);
    // Triangles of their own, world space, by their numbers sane. After appending some, mask_loose() gives them a ray
    // mask.
    std::vector<shared::Triangle>& loose() { return loose_; }
    void mask_loose(uint32_t mask) { loose_masks_.resize(loose_.size(), mask); }

    // How much has been added so far.
    struct Extent {
        size_t items = 0, loose = 0; // meshes; loose triangles
    };
    Extent extent() const { return { items_.size(), loose_.size() }; }
    // `count` meshes from `first` on were, in the last view, those of `before` from `first_before` on: these poses are
    // kept for MovingTarget::previous_positions. What is another mesh, or out of range, has not moved.
    void keep_previous(size_t first, size_t count, const MovingGeometry& before, size_t first_before);
    // The same of loose triangles.
    void keep_previous_loose(size_t first, size_t count, const MovingGeometry& before, size_t first_before);

    // Emitters got new places after the poses had been added: what was emitter first + n is now first + slots[n].
    void move_emitters(int first, std::vector<uint32_t> slots)
    {
        first_moved_emitter_ = first;
        emitter_slots_ = std::move(slots);
    }

    int emitter_at(int emitter) const
    {
        const size_t number = size_t(emitter - first_moved_emitter_);
        return emitter >= first_moved_emitter_ && number < emitter_slots_.size()
            ? first_moved_emitter_ + int(emitter_slots_[number])
            : emitter;
    }

    uint32_t first_id() const { return first_id_; }
    size_t triangle_count() const { return mesh_triangles_ + loose_count(); }
    // The room that the tree takes at most.
    size_t node_count() const;

private:
    friend class MovingWriter;
    struct Item {
        std::shared_ptr<const Md2Mesh> md2; // nullptr: `brush`
        Md2Pose pose;
        const BrushMesh* brush = nullptr;
        Transform transform;
        uint32_t material = 0; // of a brush: where its materials start in brush_materials_
        uint32_t mask = 0;
        int first_emitter = -1;
        std::shared_ptr<const SkinLamps> lamps; // of an MD2 model; nullptr: none
        bool has_previous = false;
        Md2Pose previous_pose;
        Transform previous_transform;
        uint32_t first_slot = 0, first_node = 0; // among the items'
        const MeshTree& tree() const { return md2 ? md2->tree() : brush->tree; }
    };
    bool add_item(Item&& item, const Box& bounds);
    // Numbers that fit neither ids nor the two levels' shares of the stack are rare: one tree over everything then.
    bool has_two_levels() const;
    uint32_t mesh_count() const { return uint32_t(items_.size()) + (loose_count() > 0 ? 1 : 0); }
    uint32_t loose_count() const;
    // As a quick tree may have a leaf for each triangle.
    static size_t max_nodes(size_t triangles) { return triangles > 0 ? triangles : 1; }

    uint32_t first_id_;
    std::vector<Item> items_;
    std::vector<uint32_t> brush_materials_;
    std::vector<shared::Triangle> loose_; // their ids follow the items'
    std::vector<uint32_t> loose_masks_;
    std::vector<std::array<glm::vec3, 3>> previous_loose_; // of all, or empty: none has moved
    Box bounds_; // of the items
    uint32_t mesh_triangles_ = 0, mesh_nodes_ = 0;
    bool all_have_trees_ = true;
    int first_moved_emitter_ = 0;
    std::vector<uint32_t> emitter_slots_;
};

// Where MovingWriter writes. nullptr: not wanted.
struct MovingTarget {
    shared::Triangle* triangles = nullptr; // MovingGeometry::triangle_count()
    uint32_t* masks = nullptr; // as many
    uint32_t* nodes = nullptr; // MovingGeometry::node_count() * bvh_node_words; the root is the first
    uint32_t* records = nullptr; // triangle_count() * bvh_triangle_words: the tree's triangles; with `nodes` only
    std::array<glm::vec3, 3>* previous_positions = nullptr; // triangle_count(): the corners in the last view
    TreePlace place; // of `nodes` and `records` in the arrays that hold the map's, too
};

class MovingWriter {
public:
    explicit MovingWriter(Workers& workers)
        : workers_(workers)
        , scratch_(workers.thread_count())
    {
    }

    void write(const MovingGeometry& geometry, const MovingTarget& target);

private:
    struct Scratch {
        std::vector<Float4> points, previous_points;
        std::vector<Box4> boxes;
    };
    struct Job {
        const MovingGeometry& geometry;
        const MovingTarget& target;
        float margin;

        // Of a mesh, by its first node and slot among the moving things'.
        TreePlace place(uint32_t first_node, uint32_t first_slot) const
        {
            return { target.place.first_node + first_node, target.place.first_slot + first_slot };
        }
    };
    void write_item(const Job& job, size_t item, Scratch& scratch);
    static void write_previous(const MovingGeometry::Item& item, Scratch& scratch, std::array<glm::vec3, 3>* positions);
    void write_loose(const Job& job);
    void write_one_tree(const MovingGeometry& geometry, const MovingTarget& target);

    Workers& workers_;
    std::vector<Scratch> scratch_; // per thread
    std::vector<MovingMesh> meshes_;
};

} // namespace vkpt
