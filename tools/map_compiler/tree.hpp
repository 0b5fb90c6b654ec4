// SPDX-License-Identifier: GPL-2.0-or-later
// The BSP tree of one model, its portals, and what is found by walking through them.
#pragma once

#include "tools/map_compiler/brushes.hpp"

#include <cstdint>
#include <vector>

namespace vkpt::tools {

// A polygon between two leaves (or, for visibility, two clusters).
struct Portal {
    int plane = 0; // nodes[0] lies in front of it
    int nodes[2] = { 0, 0 };
    Winding winding; // on `plane`, clockwise from its front
    int on_node = -1; // the tree node whose plane made it; -1: the world's outer box
    const BrushSide* side = nullptr; // the brush side to be seen here, null: nothing to see
    int faces[2] = { -1, -1 }; // the face seen from nodes[i]
};

struct Node {
    int plane = -1; // -1: leaf; else children[0] lies in front of it
    int children[2] = { -1, -1 };
    int parent = -1;
    bool detail = false; // divided by a detail brush: everything below is one cluster
    Bounds bounds;
    std::vector<int> portals;
    std::vector<int> faces; // on the node's plane

    // leaves
    uint32_t contents = 0;
    std::vector<int> brushes; // of the model, whose volume reaches in
    int cluster = -1, area = 0;
    int reached = 0; // steps from an entity when flooding, 0 not reached

    bool is_leaf() const { return plane < 0; }
};

struct Tree {
    std::vector<Node> nodes; // 0 is the root
    std::vector<Portal> portals;
    int outside = -1; // the leaf around the world
    Bounds bounds;

    int find_leaf(const PlaneSet& planes, const dvec3& p) const;
};

// Divides space by the sides of the model's brushes: structural before detail, visible before invisible.
Tree build_tree(const SourceMap& world, const BrushModel& model);

enum class PortalScope { leaves, clusters };
// Replaces the tree's portals. clusters: detail divisions are not entered.
void make_portals(Tree& tree, const PlaneSet& planes, PortalScope scope);

// Finds for every portal the side that shows in it and marks that side visible.
void mark_visible_sides(Tree& tree, const SourceMap& world, BrushModel& model);

struct Leak {
    int entity = 0; // the one from which the outside is reached
    std::vector<dvec3> points; // from the outside to the entity
};
// Floods from the entities. An empty result: closed, and what was not reached has become solid.
struct FloodResult {
    bool any_entity_inside = false;
    std::vector<Leak> leaks; // 0 or 1
};
FloodResult fill_outside(Tree& tree, const SourceMap& world);

// Numbers the areas that area portals divide (from 1) and fills the file's records.
struct AreaRecords {
    std::vector<formats::BspArea> areas;
    std::vector<formats::BspAreaPortal> portals;
};
AreaRecords find_areas(Tree& tree, const SourceMap& world, const WarningSink& warn);

} // namespace vkpt::tools
