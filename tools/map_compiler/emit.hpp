// SPDX-License-Identifier: GPL-2.0-or-later
// From trees and faces to the file's records.
#pragma once

#include "tools/map_compiler/faces.hpp"

#include <cstdint>

namespace vkpt::tools {

class BspWriter {
public:
    BspWriter(SourceMap& world, formats::BspFormat format);

    // In the models' order, world first. Throws MapError when a limit of the format is passed.
    void add_model(const Tree& tree, const FaceSet& faces, const BrushModel& model);
    formats::Bsp finish(AreaRecords areas, std::vector<uint8_t> visibility, int cluster_count);

private:
    int emit_node(const Tree& tree, int index);
    int emit_leaf(const Tree& tree, const Node& node);
    void emit_face(const Face& face);
    int32_t surface_edge(int from, int to);
    int vertex(const dvec3& p);
    void emit_brushes(const BrushModel& model);
    void check_limits() const;
    void check_limit(size_t count, size_t limit, std::string_view what) const;

    SourceMap& world_;
    formats::Bsp bsp_;
    const FaceSet* faces_ = nullptr;
    std::vector<int> face_numbers_; // of the current model's faces; -1 not written
    std::vector<int> brush_numbers_; // of the current model's brushes
    std::unordered_multimap<size_t, int> vertex_cells_;
    struct OpenEdge {
        int edge;
        bool reused;
    };
    std::unordered_map<uint64_t, OpenEdge> edges_; // by first << 32 | second vertex
};

} // namespace vkpt::tools
