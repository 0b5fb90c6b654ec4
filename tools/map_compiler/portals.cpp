// SPDX-License-Identifier: GPL-2.0-or-later
// Portals: every leaf's boundary, as polygons shared with its neighbours.
#include "tools/map_compiler/tree.hpp"

#include <algorithm>
#include <optional>

namespace vkpt::tools {

using namespace formats;

namespace {

constexpr double portal_epsilon = 1e-3;

class PortalMaker {
public:
    PortalMaker(Tree& tree, const PlaneSet& planes, PortalScope scope)
        : tree_(tree)
        , planes_(planes)
        , scope_(scope)
    {
    }

    void make()
    {
        tree_.portals.clear();
        if (tree_.outside < 0) {
            tree_.outside = int(tree_.nodes.size());
            tree_.nodes.emplace_back();
        }
        for (Node& n : tree_.nodes) {
            n.portals.clear();
            n.bounds = {};
        }
        make_outer_box();
        divide(0);
        std::erase_if(node(tree_.outside).portals, [&](int p) { return portal(p).winding.empty(); });
    }

private:
    Node& node(int index) { return tree_.nodes[size_t(index)]; }
    Portal& portal(int index) { return tree_.portals[size_t(index)]; }
    const Plane& plane_of(const Portal& p) const { return p.on_node < 0 ? box_[size_t(p.plane)] : planes_[p.plane]; }

    void make_outer_box()
    {
        constexpr double margin = 8;
        for (int i = 0; i < 6; i++) {
            const int axis = i / 2;
            dvec3 normal(0);
            normal[axis] = i % 2 ? -1.0 : 1.0; // inwards
            const double dist = i % 2 ? -(tree_.bounds.maxs[axis] + margin) : tree_.bounds.mins[axis] - margin;
            box_[size_t(i)] = { normal, dist, axis };
        }
        for (int i = 0; i < 6; i++) {
            Winding winding = make_base_winding(box_[size_t(i)]);
            for (int k = 0; k < 6; k++)
                if (k != i)
                    winding = clip_winding(winding, box_[size_t(k)]);
            Portal outer;
            outer.plane = i;
            outer.nodes[1] = tree_.outside;
            outer.winding = std::move(winding);
            add_portal(std::move(outer));
        }
    }

    void add_portal(Portal p)
    {
        const int index = int(tree_.portals.size());
        attach(index, p);
        tree_.portals.push_back(std::move(p));
    }

    void attach(int index, const Portal& p)
    {
        for (const int side : p.nodes)
            node(side).portals.push_back(index);
    }

    void divide(int index)
    {
        for (const int p : node(index).portals)
            node(index).bounds.add(portal(p).winding);
        if (node(index).bounds.empty() && node(index).parent >= 0) // no volume within tolerance
            node(index).bounds = node(node(index).parent).bounds;
        if (node(index).is_leaf() || (scope_ == PortalScope::clusters && node(index).detail))
            return;
        std::optional<Portal> dividing = make_dividing_portal(index);
        hand_portals_down(index);
        if (dividing)
            add_portal(std::move(*dividing));
        divide(node(index).children[0]);
        divide(node(index).children[1]);
    }

    // The node's own plane, cut down to the node's volume.
    std::optional<Portal> make_dividing_portal(int index)
    {
        const Node& n = node(index);
        Winding winding = make_base_winding(planes_[n.plane]);
        for (int child = index, parent = n.parent; parent >= 0; child = parent, parent = node(parent).parent) {
            const Plane& plane = planes_[node(parent).plane];
            winding
                = clip_winding(winding, node(parent).children[0] == child ? plane : plane.flipped(), portal_epsilon);
        }
        for (const int p : n.portals) {
            const Plane& plane = plane_of(portal(p));
            winding = clip_winding(winding, portal(p).nodes[0] == index ? plane : plane.flipped(), portal_epsilon);
        }
        if (is_tiny(winding))
            return {};
        Portal result;
        result.plane = n.plane;
        result.nodes[0] = n.children[0];
        result.nodes[1] = n.children[1];
        result.winding = std::move(winding);
        result.on_node = index;
        return result;
    }

    void hand_portals_down(int index)
    {
        const std::vector<int> portals = std::move(node(index).portals);
        node(index).portals.clear();
        for (const int p : portals)
            hand_portal_down(index, p);
    }

    void hand_portal_down(int index, int p)
    {
        const int side = portal(p).nodes[0] == index ? 0 : 1;
        std::erase(node(portal(p).nodes[side ^ 1]).portals, p);
        const Portal original = portal(p);
        const Plane& plane = planes_[node(index).plane];
        SplitWinding split = split_winding(original.winding, plane, portal_epsilon);
        if (split.on) { // on the dividing plane: the child that shares the node's side of the portal has it
            const bool same_way = glm::dot(plane_of(original).normal, plane.normal) > 0;
            (same_way == (side == 0) ? split.front : split.back) = original.winding;
        }
        portal(p).winding.clear();
        for (const int child : { 0, 1 }) {
            Winding& winding = child == 0 ? split.front : split.back;
            if (is_tiny(winding))
                continue;
            Portal part = original;
            part.nodes[side] = node(index).children[child];
            part.winding = std::move(winding);
            if (!portal(p).winding.empty()) {
                add_portal(std::move(part));
            } else {
                attach(p, part);
                portal(p) = std::move(part);
            }
        }
    }

    Tree& tree_;
    const PlaneSet& planes_;
    PortalScope scope_;
    std::array<Plane, 6> box_;
};

// Which brush side is to be seen between the portal's two leaves: one on the portal's plane of a brush that has the
// contents that show; else (the plane was merged or comes from elsewhere) the nearest in direction.
BrushSide* find_side(const Tree& tree, const SourceMap& world, BrushModel& model, const Portal& portal)
{
    const Node& a = tree.nodes[size_t(portal.nodes[0])];
    const Node& b = tree.nodes[size_t(portal.nodes[1])];
    const uint32_t showing = visible_contents(a.contents ^ b.contents);
    if (showing == 0)
        return nullptr;
    BrushSide* best = nullptr;
    double best_dot = 0;
    for (const Node* node : { &b, &a }) {
        for (const int index : node->brushes) {
            Brush& brush = model.brushes[size_t(index)];
            if (!(brush.contents & showing))
                continue;
            const dvec3 outwards = world.planes[portal.plane].normal * (node == &b ? 1.0 : -1.0);
            for (BrushSide& side : brush.sides) {
                if (side.bevel || !side.divides)
                    continue;
                if ((side.plane & ~1) == (portal.plane & ~1))
                    return &side;
                if (const double dot = glm::dot(world.planes[side.plane].normal, outwards); dot > best_dot) {
                    best_dot = dot;
                    best = &side;
                }
            }
        }
    }
    return best;
}

} // namespace

void make_portals(Tree& tree, const PlaneSet& planes, PortalScope scope) { PortalMaker(tree, planes, scope).make(); }

void mark_visible_sides(Tree& tree, const SourceMap& world, BrushModel& model)
{
    for (Brush& brush : model.brushes)
        for (BrushSide& side : brush.sides)
            side.visible = side.divides && side.flags & SURF_HINT;
    for (Portal& portal : tree.portals) {
        portal.side = nullptr;
        if (portal.winding.empty() || portal.on_node < 0)
            continue;
        BrushSide* side = find_side(tree, world, model, portal);
        portal.side = side;
        if (side)
            side->visible = true;
    }
}

} // namespace vkpt::tools
