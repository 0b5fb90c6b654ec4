// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/map_compiler/emit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkpt::tools {

using namespace formats;

namespace {

// Whole numbers that IBSP has room for, in either format.
void store_bounds(const Bounds& bounds, float (&mins)[3], float (&maxs)[3])
{
    for (int axis = 0; axis < 3; axis++) {
        mins[axis] = float(std::clamp(std::floor(bounds.mins[axis]), -32768.0, 32767.0));
        maxs[axis] = float(std::clamp(std::ceil(bounds.maxs[axis]), -32768.0, 32767.0));
    }
}

size_t cell_key(const dvec3& p, const glm::ivec3& step)
{
    const glm::ivec3 cell = glm::ivec3(glm::floor(p)) + step;
    return (size_t(uint32_t(cell.x)) * 73856093u) ^ (size_t(uint32_t(cell.y)) * 19349663u)
        ^ (size_t(uint32_t(cell.z)) * 83492791u);
}

} // namespace

BspWriter::BspWriter(SourceMap& world, BspFormat format)
    : world_(world)
{
    bsp_.format = format;
    bsp_.name = world.source.file;
    // The engine takes leaf 0 for everything solid, and an edge's sign for its direction: edge 0 cannot be used.
    BspLeaf solid {};
    solid.contents = CONTENTS_SOLID;
    solid.cluster = -1;
    bsp_.leaves.push_back(solid);
    bsp_.edges.push_back({});
}

void BspWriter::check_limit(size_t count, size_t limit, std::string_view what) const
{
    if (count > limit)
        world_.source.fail(0,
            fmt::format("{} {} exceed the format's limit of {}; simplify the map, make brushes detail, or write a QBSP "
                        "(--qbsp)",
                count, what, limit));
}

void BspWriter::add_model(const Tree& tree, const FaceSet& faces, const BrushModel& model)
{
    faces_ = &faces;
    face_numbers_.assign(faces.faces.size(), -1);
    BspModel record {};
    Bounds bounds;
    for (const Brush& brush : model.brushes)
        bounds.add(brush.bounds);
    record.mins = glm::vec3(bounds.mins);
    record.maxs = glm::vec3(bounds.maxs);
    record.origin = glm::vec3(model.origin);
    record.first_face = int(bsp_.faces.size());
    emit_brushes(model);
    // Faces lie in the file in the order of their nodes: number them before the leaves that name them.
    record.head_node = emit_node(tree, 0);
    record.face_count = int(bsp_.faces.size()) - record.first_face;
    bsp_.models.push_back(record);
}

void BspWriter::emit_brushes(const BrushModel& model)
{
    brush_numbers_.assign(model.brushes.size(), -1);
    for (size_t i = 0; i < model.brushes.size(); i++) {
        const Brush& brush = model.brushes[i];
        if (brush.contents == 0)
            continue;
        brush_numbers_[i] = int(bsp_.brushes.size());
        bsp_.brushes.push_back({ int(bsp_.brush_sides.size()), int(brush.sides.size()), brush.contents });
        for (const BrushSide& side : brush.sides)
            bsp_.brush_sides.push_back({ uint32_t(side.plane), side.texinfo });
    }
}

int BspWriter::emit_node(const Tree& tree, int index)
{
    const Node& node = tree.nodes[size_t(index)];
    if (node.is_leaf())
        return -(emit_leaf(tree, node) + 1);
    const size_t number = bsp_.nodes.size();
    bsp_.nodes.emplace_back();
    BspNode record {};
    record.plane = node.plane;
    store_bounds(node.bounds, record.mins, record.maxs);
    record.first_face = uint32_t(bsp_.faces.size());
    for (const int face : node.faces) {
        face_numbers_[size_t(face)] = int(bsp_.faces.size());
        emit_face(faces_->faces[size_t(face)]);
    }
    record.face_count = uint32_t(bsp_.faces.size() - record.first_face);
    for (int side = 0; side < 2; side++)
        record.children[side] = emit_node(tree, node.children[side]);
    bsp_.nodes[number] = record;
    return int(number);
}

int BspWriter::emit_leaf(const Tree& tree, const Node& node)
{
    BspLeaf leaf {};
    leaf.contents = node.contents;
    leaf.cluster = node.cluster;
    leaf.area = node.area;
    store_bounds(node.bounds, leaf.mins, leaf.maxs);
    leaf.first_leaf_face = uint32_t(bsp_.leaf_faces.size());
    std::vector<int> seen;
    const int self = int(&node - tree.nodes.data());
    for (const int p : node.portals) {
        const Portal& portal = tree.portals[size_t(p)];
        if (const int face = portal.faces[portal.nodes[0] == self ? 0 : 1]; face >= 0)
            faces_->collect(face, seen);
    }
    std::ranges::sort(seen);
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    for (const int face : seen)
        if (face_numbers_[size_t(face)] >= 0)
            bsp_.leaf_faces.push_back(uint32_t(face_numbers_[size_t(face)]));
    leaf.leaf_face_count = uint32_t(bsp_.leaf_faces.size() - leaf.first_leaf_face);
    leaf.first_leaf_brush = uint32_t(bsp_.leaf_brushes.size());
    for (const int brush : node.brushes)
        if (brush_numbers_[size_t(brush)] >= 0)
            bsp_.leaf_brushes.push_back(uint32_t(brush_numbers_[size_t(brush)]));
    leaf.leaf_brush_count = uint32_t(bsp_.leaf_brushes.size() - leaf.first_leaf_brush);
    bsp_.leaves.push_back(leaf);
    return int(bsp_.leaves.size()) - 1;
}

void BspWriter::emit_face(const Face& face)
{
    std::vector<int> corners;
    for (const dvec3& p : face.winding)
        if (const int index = vertex(p); corners.empty() || (corners.back() != index))
            corners.push_back(index);
    while (corners.size() > 1 && corners.front() == corners.back())
        corners.pop_back();
    if (corners.size() < 3)
        return;
    BspFace record {};
    record.plane = uint32_t(face.plane & ~1); // as the nodes: the positive one of the pair
    record.side = uint32_t(face.plane & 1);
    record.texinfo = uint32_t(face.texinfo);
    record.first_edge = int(bsp_.surface_edges.size());
    record.edge_count = uint32_t(corners.size());
    std::ranges::fill(record.styles, uint8_t(255));
    record.light_offset = -1;
    for (size_t i = 0; i < corners.size(); i++)
        bsp_.surface_edges.push_back(surface_edge(corners[i], corners[(i + 1) % corners.size()]));
    bsp_.faces.push_back(record);
}

int32_t BspWriter::surface_edge(int from, int to)
{
    const uint64_t reverse = uint64_t(uint32_t(to)) << 32 | uint32_t(from);
    if (const auto it = edges_.find(reverse); it != edges_.end() && !it->second.reused) {
        it->second.reused = true; // an edge is shared by two faces
        return -it->second.edge;
    }
    const int edge = int(bsp_.edges.size());
    bsp_.edges.push_back({ { uint32_t(from), uint32_t(to) } });
    edges_.insert_or_assign(uint64_t(uint32_t(from)) << 32 | uint32_t(to), OpenEdge { edge, false });
    return edge;
}

int BspWriter::vertex(const dvec3& p)
{
    constexpr double same_distance = 0.03;
    dvec3 snapped = p;
    for (int axis = 0; axis < 3; axis++)
        if (std::abs(p[axis] - std::round(p[axis])) < 0.01)
            snapped[axis] = std::round(p[axis]);
    for (int x = -1; x <= 1; x++)
        for (int y = -1; y <= 1; y++)
            for (int z = -1; z <= 1; z++) {
                const auto [first, last] = vertex_cells_.equal_range(cell_key(snapped, { x, y, z }));
                for (auto it = first; it != last; ++it)
                    if (glm::distance(dvec3(bsp_.vertices[size_t(it->second)]), snapped) < same_distance)
                        return it->second;
            }
    const int index = int(bsp_.vertices.size());
    bsp_.vertices.emplace_back(snapped);
    vertex_cells_.emplace(cell_key(snapped, {}), index);
    return index;
}

// 16-bit fields; the engine's own arrays are no larger.
void BspWriter::check_limits() const
{
    check_limit(bsp_.planes.size(), 65536, "planes");
    check_limit(bsp_.vertices.size(), 65536, "vertices");
    check_limit(bsp_.faces.size(), 65535, "faces");
    check_limit(bsp_.leaves.size(), 32767, "leaves");
    check_limit(bsp_.nodes.size(), 65536, "nodes");
    check_limit(bsp_.leaf_faces.size(), 65535, "faces in leaves");
    check_limit(bsp_.leaf_brushes.size(), 65535, "brushes in leaves");
    check_limit(bsp_.texinfos.size(), 8192, "texture placements");
    check_limit(bsp_.brushes.size(), 8192, "brushes");
    check_limit(bsp_.brush_sides.size(), 65536, "brush sides");
    check_limit(bsp_.edges.size(), 128000, "edges");
    check_limit(bsp_.surface_edges.size(), 256000, "surface edges");
    check_limit(bsp_.models.size(), 1024, "brush models");
    check_limit(bsp_.entity_text.size(), 0x40000, "bytes of entity text");
}

Bsp BspWriter::finish(AreaRecords areas, std::vector<uint8_t> visibility, int cluster_count)
{
    bsp_.entity_text = world_.entity_text();
    for (const Plane& plane : world_.planes.all())
        bsp_.planes.push_back({ glm::vec3(plane.normal), float(plane.dist), plane.type });
    bsp_.texinfos = world_.texinfos;
    bsp_.areas = std::move(areas.areas);
    bsp_.area_portals = std::move(areas.portals);
    bsp_.visibility = std::move(visibility);
    bsp_.cluster_count = bsp_.visibility.empty() ? 0 : cluster_count;
    if (bsp_.vertices.empty())
        bsp_.vertices.push_back({}); // of edge 0, where nothing is drawn
    if (bsp_.format == BspFormat::ibsp)
        check_limits();
    return std::move(bsp_);
}

} // namespace vkpt::tools
