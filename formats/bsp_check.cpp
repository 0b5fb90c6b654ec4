// SPDX-License-Identifier: GPL-2.0-or-later
// Every index of a freshly read map, checked once.
#include "formats/bsp_disk.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace formats::bsp_disk {

namespace {

// Deep enough for any map that was ever compiled, shallow enough to walk the tree by recursion.
constexpr int max_tree_depth = 4096;
// Compilers cut faces at 20 to 64 corners; pictures take turns by the dozen at most.
constexpr size_t max_face_edges = 64;
constexpr size_t max_animation_frames = 256;
// Of the faces that leaves show, each counted in every leaf: some 60,000 in large maps of 16-bit indices. Larger files
// may have one for each of their bytes, which is more than the records of faces, edges and leaves leave room for.
constexpr size_t max_leaf_face_edges = size_t(1) << 20;
// What an IBSP's leaves have room for. Sets of clusters for each cluster, a bit for each pair, take 128 MB then.
constexpr size_t max_clusters = size_t(INT16_MAX) + 1;

bool is_finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

class Checker {
public:
    Checker(Bsp& bsp, const Directory& directory, std::string_view file)
        : bsp_(bsp)
        , directory_(directory)
        , record_sizes_(record_sizes(bsp.format))
        , file_(file)
    {
    }

    void check_all()
    {
        check_presence();
        check_geometry();
        check_texinfos();
        check_faces();
        check_leaves();
        check_nodes();
        check_tree();
        check_models();
        check_brushes();
        check_areas();
        check_visibility();
        drop_missing_light();
    }

private:
    [[noreturn]] void fail(Lump lump, size_t record, const std::string& reason) const
    {
        throw FormatError(file_, directory_[lump].offset + record * record_sizes_[lump],
            std::string("lump ") + lump_names[lump] + ", record " + std::to_string(record) + ": " + reason);
    }

    // first .. first + count must lie in 0 .. size.
    template <class T>
    void check_run(Lump lump, const std::vector<T>& records, const T& record, int64_t first, int64_t count, size_t size,
        const char* what) const
    {
        if (first < 0 || count < 0 || first + count > int64_t(size))
            fail(lump, size_t(&record - records.data()),
                std::string(what) + " " + std::to_string(first) + " + " + std::to_string(count) + " of "
                    + std::to_string(size));
    }

    // Runs that do not overlap: together they are no longer than what they are runs of. Adds `count` to `total`.
    template <class T>
    void check_total(Lump lump, const std::vector<T>& records, const T& record, size_t& total, size_t count,
        size_t size, const char* what) const
    {
        total += count;
        if (total > size)
            fail(lump, size_t(&record - records.data()),
                std::string("with it there are ") + std::to_string(total) + " " + what + ", more than the "
                    + std::to_string(size) + " that may be: the same are used again and again");
    }

    template <class T>
    void check_index(
        Lump lump, const std::vector<T>& records, const T& record, int64_t index, size_t size, const char* what) const
    {
        if (index < 0 || index >= int64_t(size))
            fail(lump, size_t(&record - records.data()),
                std::string(what) + " " + std::to_string(index) + " of " + std::to_string(size));
    }

    template <class T> void check_bounds(Lump lump, const std::vector<T>& records, const T& record) const
    {
        const auto is_number = [](float x) { return std::isfinite(x); };
        if (!std::ranges::all_of(record.mins, is_number) || !std::ranges::all_of(record.maxs, is_number))
            fail(lump, size_t(&record - records.data()), "bounds are not finite");
    }

    void check_presence() const
    {
        if (bsp_.models.empty())
            fail(Models, 0, "the map has no world model");
        if (bsp_.leaves.empty())
            fail(Leaves, 0, "the map has no leaves");
    }

    void check_geometry() const
    {
        for (size_t i = 0; i < bsp_.vertices.size(); i++)
            if (!is_finite(bsp_.vertices[i]))
                fail(Vertices, i, "not a finite position");
        for (size_t i = 0; i < bsp_.planes.size(); i++) {
            const BspPlane& plane = bsp_.planes[i];
            const float squared
                = plane.normal.x * plane.normal.x + plane.normal.y * plane.normal.y + plane.normal.z * plane.normal.z;
            if (!std::isfinite(plane.dist) || !(squared > 0.9f && squared < 1.1f))
                fail(Planes, i, "not a plane with a unit normal");
        }
        for (const BspEdge& edge : bsp_.edges)
            for (const uint32_t vertex : edge.vertices)
                check_index(Edges, bsp_.edges, edge, vertex, bsp_.vertices.size(), "vertex");
        for (const int32_t& edge : bsp_.surface_edges)
            check_index(SurfaceEdges, bsp_.surface_edges, edge, std::abs(int64_t(edge)), bsp_.edges.size(), "edge");
    }

    void check_texinfos()
    {
        for (size_t i = 0; i < bsp_.texinfos.size(); i++) {
            const BspTexinfo& t = bsp_.texinfos[i];
            if (!is_finite(t.s_axis) || !is_finite(t.t_axis) || !std::isfinite(t.s_offset)
                || !std::isfinite(t.t_offset))
                fail(Texinfos, i, "texture axes are not finite");
            if (t.next < -1 || t.next >= int32_t(bsp_.texinfos.size()))
                fail(Texinfos, i, "next frame " + std::to_string(t.next) + " does not exist");
        }
        cut_animation_chains();
        check_animation_lengths();
    }

    // A chain must end or come back to where it started, so that a walk "until the end or the start" always stops.
    // Where a chain runs into a ring that it is not part of, it is cut there. (Some compilers write 0 for "no next".)
    void cut_animation_chains()
    {
        enum State : uint8_t { Unseen, OnPath, Ends, InRing };
        std::vector<State> state(bsp_.texinfos.size(), Unseen);
        std::vector<size_t> path;
        for (size_t start = 0; start < state.size(); start++) {
            path.clear();
            int32_t at = int32_t(start);
            for (; at >= 0 && state[size_t(at)] == Unseen; at = bsp_.texinfos[size_t(at)].next) {
                state[size_t(at)] = OnPath;
                path.push_back(size_t(at));
            }
            auto ring = path.end();
            if (at >= 0 && state[size_t(at)] == OnPath)
                ring = std::find(path.begin(), path.end(), size_t(at));
            if (at >= 0 && state[size_t(at)] != Ends && ring != path.begin())
                bsp_.texinfos[*std::prev(ring)].next = -1;
            for (auto texinfo = path.begin(); texinfo != path.end(); ++texinfo)
                state[*texinfo] = texinfo < ring ? Ends : InRing;
        }
    }

    // After the cut: a chain ends, or comes back to its start.
    void check_animation_lengths() const
    {
        for (size_t start = 0; start < bsp_.texinfos.size(); start++) {
            size_t frames = 1;
            for (int32_t at = bsp_.texinfos[start].next; at >= 0 && at != int32_t(start);
                 at = bsp_.texinfos[size_t(at)].next)
                if (++frames > max_animation_frames)
                    fail(Texinfos, start,
                        "an animation of more than " + std::to_string(max_animation_frames) + " frames");
        }
    }

    void check_faces() const
    {
        size_t edges = 0;
        for (const BspFace& face : bsp_.faces) {
            check_index(Faces, bsp_.faces, face, face.plane, bsp_.planes.size(), "plane");
            check_index(Faces, bsp_.faces, face, face.texinfo, bsp_.texinfos.size(), "texinfo");
            check_run(
                Faces, bsp_.faces, face, face.first_edge, face.edge_count, bsp_.surface_edges.size(), "surface edges");
            if (face.edge_count < 3)
                fail(Faces, size_t(&face - bsp_.faces.data()), "fewer than three edges");
            if (face.edge_count > max_face_edges)
                fail(Faces, size_t(&face - bsp_.faces.data()),
                    std::to_string(face.edge_count) + " edges, more than the " + std::to_string(max_face_edges)
                        + " that a face may have");
            check_total(
                Faces, bsp_.faces, face, edges, face.edge_count, bsp_.surface_edges.size(), "surface edges of faces");
        }
    }

    void check_leaves() const
    {
        for (const uint32_t& face : bsp_.leaf_faces)
            check_index(LeafFaces, bsp_.leaf_faces, face, face, bsp_.faces.size(), "face");
        for (const uint32_t& brush : bsp_.leaf_brushes)
            check_index(LeafBrushes, bsp_.leaf_brushes, brush, brush, bsp_.brushes.size(), "brush");
        // Without visibility the clusters' numbers are whatever the compiler left; they only must not be negative
        // indices.
        const size_t clusters = bsp_.visibility.empty() ? max_clusters : size_t(std::max(bsp_.cluster_count, 0));
        const size_t max_edges = std::max(max_leaf_face_edges, bsp_.file_size);
        size_t faces = 0, brushes = 0, edges = 0;
        for (const BspLeaf& leaf : bsp_.leaves) {
            check_run(Leaves, bsp_.leaves, leaf, leaf.first_leaf_face, leaf.leaf_face_count, bsp_.leaf_faces.size(),
                "leaf faces");
            check_run(Leaves, bsp_.leaves, leaf, leaf.first_leaf_brush, leaf.leaf_brush_count, bsp_.leaf_brushes.size(),
                "leaf brushes");
            check_total(Leaves, bsp_.leaves, leaf, faces, leaf.leaf_face_count, bsp_.leaf_faces.size(), "leaf faces");
            check_total(
                Leaves, bsp_.leaves, leaf, brushes, leaf.leaf_brush_count, bsp_.leaf_brushes.size(), "leaf brushes");
            check_total(Leaves, bsp_.leaves, leaf, edges, count_edges(leaf), max_edges, "edges of leaves' faces");
            check_bounds(Leaves, bsp_.leaves, leaf);
            if (leaf.cluster != -1)
                check_index(Leaves, bsp_.leaves, leaf, leaf.cluster, clusters, "cluster");
            if (leaf.area != -1)
                check_index(Leaves, bsp_.leaves, leaf, leaf.area, std::max<size_t>(bsp_.areas.size(), 1), "area");
        }
    }

    size_t count_edges(const BspLeaf& leaf) const
    {
        size_t edges = 0;
        for (size_t i = 0; i < leaf.leaf_face_count; i++)
            edges += bsp_.faces[bsp_.leaf_faces[leaf.first_leaf_face + i]].edge_count;
        return edges;
    }

    void check_nodes() const
    {
        for (const BspNode& node : bsp_.nodes) {
            check_index(Nodes, bsp_.nodes, node, node.plane, bsp_.planes.size(), "plane");
            check_bounds(Nodes, bsp_.nodes, node);
            check_run(Nodes, bsp_.nodes, node, node.first_face, node.face_count, bsp_.faces.size(), "faces");
            for (const int32_t child : node.children)
                check_child(Nodes, bsp_.nodes, node, child);
        }
    }

    template <class T> void check_child(Lump lump, const std::vector<T>& records, const T& record, int32_t child) const
    {
        if (child >= 0)
            check_index(lump, records, record, child, bsp_.nodes.size(), "node");
        else
            check_index(lump, records, record, -1 - int64_t(child), bsp_.leaves.size(), "leaf");
    }

    // Every node has one parent at most and hangs on a root: no cycles, and a walk visits each node once.
    void check_tree() const
    {
        std::vector<uint8_t> has_parent(bsp_.nodes.size(), 0);
        for (size_t i = 0; i < bsp_.nodes.size(); i++)
            for (const int32_t child : bsp_.nodes[i].children)
                if (child >= 0 && std::exchange(has_parent[size_t(child)], uint8_t(1)))
                    fail(Nodes, i, "its child " + std::to_string(child) + " has another parent already");
        size_t visited = 0;
        std::vector<std::pair<int32_t, int>> open; // node, depth
        for (size_t root = 0; root < bsp_.nodes.size(); root++) {
            if (has_parent[root])
                continue;
            open.emplace_back(int32_t(root), 1);
            while (!open.empty()) {
                const auto [node, depth] = open.back();
                open.pop_back();
                visited++;
                if (depth > max_tree_depth)
                    fail(Nodes, size_t(node), "the tree is deeper than " + std::to_string(max_tree_depth));
                for (const int32_t child : bsp_.nodes[size_t(node)].children)
                    if (child >= 0)
                        open.emplace_back(child, depth + 1);
            }
        }
        if (visited != bsp_.nodes.size())
            fail(Nodes, 0, "some nodes form a cycle");
    }

    void check_models() const
    {
        size_t faces = 0;
        for (const BspModel& model : bsp_.models) {
            check_run(Models, bsp_.models, model, model.first_face, model.face_count, bsp_.faces.size(), "faces");
            check_total(
                Models, bsp_.models, model, faces, size_t(model.face_count), bsp_.faces.size(), "faces of models");
            check_child(Models, bsp_.models, model, model.head_node);
            if (!is_finite(model.mins) || !is_finite(model.maxs) || !is_finite(model.origin))
                fail(Models, size_t(&model - bsp_.models.data()), "bounds or origin are not finite");
        }
    }

    void check_brushes() const
    {
        for (const BspBrush& brush : bsp_.brushes)
            check_run(
                Brushes, bsp_.brushes, brush, brush.first_side, brush.side_count, bsp_.brush_sides.size(), "sides");
        for (const BspBrushSide& side : bsp_.brush_sides) {
            check_index(BrushSides, bsp_.brush_sides, side, side.plane, bsp_.planes.size(), "plane");
            if (side.texinfo != -1)
                check_index(BrushSides, bsp_.brush_sides, side, side.texinfo, bsp_.texinfos.size(), "texinfo");
        }
    }

    void check_areas() const
    {
        for (const BspArea& area : bsp_.areas)
            check_run(Areas, bsp_.areas, area, area.first_area_portal, area.area_portal_count, bsp_.area_portals.size(),
                "area portals");
        for (const BspAreaPortal& portal : bsp_.area_portals)
            check_index(AreaPortals, bsp_.area_portals, portal, portal.other_area, bsp_.areas.size(), "area");
    }

    void check_visibility() const
    {
        if (bsp_.visibility.empty())
            return;
        constexpr size_t row_size = 2 * sizeof(int32_t); // offsets of the PVS and the PHS row
        const size_t room = (bsp_.visibility.size() - sizeof(int32_t)) / row_size;
        if (bsp_.cluster_count < 0 || size_t(bsp_.cluster_count) > room)
            throw FormatError(file_, directory_[Visibility].offset,
                "lump visibility: " + std::to_string(bsp_.cluster_count) + " clusters do not fit");
        if (size_t(bsp_.cluster_count) > max_clusters)
            throw FormatError(file_, directory_[Visibility].offset,
                "lump visibility: " + std::to_string(bsp_.cluster_count) + " clusters, more than the "
                    + std::to_string(max_clusters) + " that a map may have; make small brushes detail");
        for (size_t i = 0; i < size_t(bsp_.cluster_count); i++) {
            int32_t offset;
            const size_t at = sizeof(int32_t) + i * row_size;
            std::memcpy(&offset, bsp_.visibility.data() + at, sizeof(offset));
            if (offset < 0 || size_t(offset) >= bsp_.visibility.size())
                throw FormatError(file_, directory_[Visibility].offset + at,
                    "lump visibility: the row of cluster " + std::to_string(i) + " lies outside of the lump");
        }
    }

    // Not an error: maps are shipped unlit, or with their lightmaps stripped.
    void drop_missing_light()
    {
        for (size_t i = 0; i < bsp_.faces.size(); i++) {
            BspFace& face = bsp_.faces[i];
            const Bsp::LightmapExtent extent = bsp_.lightmap_extent(i);
            const auto styles
                = std::find(std::begin(face.styles), std::end(face.styles), uint8_t(255)) - std::begin(face.styles);
            const int64_t bytes = int64_t(extent.size.x) * extent.size.y * 3 * styles;
            if (face.light_offset < 0 || face.light_offset + bytes > int64_t(bsp_.lighting.size()))
                face.light_offset = -1;
        }
    }

    Bsp& bsp_;
    const Directory& directory_;
    const RecordSizes record_sizes_;
    std::string_view file_;
};

} // namespace

RecordSizes record_sizes(BspFormat format)
{
    RecordSizes sizes;
    sizes.fill(1);
    const Bsp none;
    with_format(format, [&](auto constant) {
        for_each_lump(none, [&]<class T>(Lump lump, const std::vector<T>&) {
            sizes[lump] = sizeof(typename OnDisk<constant.value, T>::Record);
        });
    });
    return sizes;
}

void check(Bsp& bsp, const Directory& directory, std::string_view file) { Checker(bsp, directory, file).check_all(); }

} // namespace formats::bsp_disk
