// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/map_compiler/tree.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace vkpt::tools {

using namespace formats;

namespace {

struct FragmentSide {
    int plane;
    const BrushSide* original; // null: made by a division
    Winding winding;
    bool on_node; // lies on a plane above in the tree
};

// The part of a brush inside a node.
struct Fragment {
    int brush;
    std::vector<FragmentSide> sides;
    Bounds bounds;
};

struct SplitFragment {
    bool in_front = false, in_back = false;
    Fragment front, back;
};

struct PlaneTally {
    int front = 0, back = 0, splits = 0, facing = 0;
    bool slivers = false, splits_hint = false;
};

class TreeBuilder {
public:
    TreeBuilder(const SourceMap& world, const BrushModel& model)
        : world_(world)
        , model_(model)
    {
    }

    Tree build()
    {
        std::vector<Fragment> fragments;
        for (size_t i = 0; i < model_.brushes.size(); i++)
            fragments.push_back(make_fragment(int(i)));
        for (const Fragment& fragment : fragments)
            tree_.bounds.add(fragment.bounds);
        tree_.nodes.emplace_back();
        build_node(0, std::move(fragments));
        return std::move(tree_);
    }

private:
    Fragment make_fragment(int index) const
    {
        const Brush& brush = model_.brushes[size_t(index)];
        Fragment fragment { index, {}, brush.bounds };
        for (const BrushSide& side : brush.sides)
            if (!side.bevel)
                fragment.sides.push_back({ side.plane, &side, side.winding, false });
        return fragment;
    }

    const Brush& brush_of(const Fragment& fragment) const { return model_.brushes[size_t(fragment.brush)]; }

    void build_node(int index, std::vector<Fragment> fragments)
    {
        bool detail = false;
        const int plane = is_filled(fragments) ? -1 : choose_plane(fragments, detail);
        if (plane < 0) {
            make_leaf(tree_.nodes[size_t(index)], fragments);
            return;
        }
        std::vector<Fragment> front, back;
        for (Fragment& fragment : fragments) {
            SplitFragment split = split_fragment(std::move(fragment), plane);
            if (split.in_front)
                front.push_back(std::move(split.front));
            if (split.in_back)
                back.push_back(std::move(split.back));
        }
        fragments.clear();
        const int child = int(tree_.nodes.size());
        tree_.nodes.resize(tree_.nodes.size() + 2);
        Node& node = tree_.nodes[size_t(index)];
        node.plane = plane;
        node.detail = detail;
        for (int side = 0; side < 2; side++) {
            node.children[side] = child + side;
            tree_.nodes[size_t(child + side)].parent = index;
        }
        build_node(child, std::move(front));
        build_node(child + 1, std::move(back));
    }

    // A structural wall fills the whole node: nothing can show inside it.
    bool is_filled(const std::vector<Fragment>& fragments) const
    {
        return std::ranges::any_of(fragments, [&](const Fragment& fragment) {
            const Brush& brush = brush_of(fragment);
            return brush.contents & CONTENTS_SOLID && !brush.is_detail()
                && std::ranges::all_of(fragment.sides, &FragmentSide::on_node);
        });
    }

    void make_leaf(Node& leaf, const std::vector<Fragment>& fragments) const
    {
        for (const Fragment& fragment : fragments) {
            leaf.contents |= brush_of(fragment).contents;
            leaf.brushes.push_back(fragment.brush);
        }
    }

    // -1: every side is used.
    int choose_plane(const std::vector<Fragment>& fragments, bool& detail) const
    {
        for (const bool visible : { true, false })
            for (const bool want_detail : { false, true })
                if (const int plane = choose_plane_among(fragments, visible, want_detail); plane >= 0) {
                    detail = want_detail;
                    return plane;
                }
        return -1;
    }

    int choose_plane_among(const std::vector<Fragment>& fragments, bool visible, bool detail) const
    {
        std::unordered_set<int> tried;
        int best_plane = -1, best_value = 0;
        for (const Fragment& fragment : fragments) {
            if (brush_of(fragment).is_detail() != detail)
                continue;
            for (const FragmentSide& side : fragment.sides) {
                if (side.on_node || !side.original || !side.original->divides || side.original->visible != visible)
                    continue;
                const int plane = side.plane & ~1;
                if (!tried.insert(plane).second)
                    continue;
                const int value = rate_plane(fragments, plane, side.original->flags & SURF_HINT);
                if (best_plane < 0 || value > best_value) {
                    best_plane = plane;
                    best_value = value;
                }
            }
        }
        return best_plane;
    }

    // Many sides on the plane and an even division are good; cutting brushes is bad, into slivers worst.
    int rate_plane(const std::vector<Fragment>& fragments, int plane, bool hint) const
    {
        PlaneTally tally;
        for (const Fragment& fragment : fragments)
            tally_fragment(fragment, plane, tally);
        int value = 5 * tally.facing - 5 * tally.splits - std::abs(tally.front - tally.back);
        if (world_.planes[plane].type < 3)
            value += 5;
        if (tally.slivers)
            value -= 1000;
        if (tally.splits_hint && !hint)
            value -= 1000000;
        return value;
    }

    void tally_fragment(const Fragment& fragment, int plane_index, PlaneTally& tally) const
    {
        const Plane& plane = world_.planes[plane_index];
        for (const FragmentSide& side : fragment.sides)
            if ((side.plane & ~1) == plane_index) {
                (side.plane == plane_index ? tally.back : tally.front)++;
                tally.facing += side.original != nullptr;
                return;
            }
        double front = 0, back = 0;
        measure(fragment.bounds, plane, front, back);
        if (front > on_epsilon && back < -on_epsilon)
            measure(fragment, plane, front, back);
        tally.front += front > on_epsilon;
        tally.back += back < -on_epsilon;
        if (front <= on_epsilon || back >= -on_epsilon)
            return;
        if (front < 1.0 || back > -1.0)
            tally.slivers = true;
        for (const FragmentSide& side : fragment.sides)
            if (side.original && !side.on_node && side.original->divides && straddles(side.winding, plane)) {
                tally.splits++;
                tally.splits_hint |= bool(side.original->flags & SURF_HINT);
            }
    }

    static void measure(const Bounds& bounds, const Plane& plane, double& front, double& back)
    {
        const dvec3 centre = (bounds.mins + bounds.maxs) * 0.5, half = (bounds.maxs - bounds.mins) * 0.5;
        const double reach = glm::dot(glm::abs(plane.normal), half);
        front = plane.distance(centre) + reach;
        back = plane.distance(centre) - reach;
    }

    static void measure(const Fragment& fragment, const Plane& plane, double& front, double& back)
    {
        front = -1e30;
        back = 1e30;
        for (const FragmentSide& side : fragment.sides)
            for (const dvec3& p : side.winding) {
                front = std::max(front, plane.distance(p));
                back = std::min(back, plane.distance(p));
            }
    }

    static bool straddles(const Winding& winding, const Plane& plane)
    {
        bool front = false, back = false;
        for (const dvec3& p : winding) {
            front |= plane.distance(p) > on_epsilon;
            back |= plane.distance(p) < -on_epsilon;
        }
        return front && back;
    }

    SplitFragment split_fragment(Fragment fragment, int plane_index) const
    {
        SplitFragment result;
        for (FragmentSide& side : fragment.sides)
            if ((side.plane & ~1) == plane_index) {
                side.on_node = true;
                place(result, std::move(fragment), side.plane != plane_index);
                return result;
            }
        const Plane& plane = world_.planes[plane_index];
        double front = 0, back = 0;
        measure(fragment, plane, front, back);
        if (front < 2 * on_epsilon || back > -2 * on_epsilon) {
            place(result, std::move(fragment), front > -back);
            return result;
        }
        Winding cut = make_base_winding(plane);
        for (const FragmentSide& side : fragment.sides)
            if (!cut.empty())
                cut = clip_winding(cut, world_.planes[side.plane ^ 1], 1e-4);
        if (is_tiny(cut)) { // grazes an edge
            place(result, std::move(fragment), front > -back);
            return result;
        }
        cut_fragment(result, fragment, plane_index, cut);
        return result;
    }

    static void place(SplitFragment& result, Fragment fragment, bool in_front)
    {
        (in_front ? result.in_front : result.in_back) = true;
        (in_front ? result.front : result.back) = std::move(fragment);
    }

    void cut_fragment(SplitFragment& result, const Fragment& fragment, int plane_index, const Winding& cut) const
    {
        const Plane& plane = world_.planes[plane_index];
        result.front.brush = result.back.brush = fragment.brush;
        for (const FragmentSide& side : fragment.sides) {
            SplitWinding split = split_winding(side.winding, plane, 0.0);
            if (split.front.size() >= 3)
                result.front.sides.push_back({ side.plane, side.original, std::move(split.front), side.on_node });
            if (split.back.size() >= 3)
                result.back.sides.push_back({ side.plane, side.original, std::move(split.back), side.on_node });
        }
        for (Fragment* half : { &result.front, &result.back })
            for (const FragmentSide& side : half->sides)
                half->bounds.add(side.winding);
        result.in_front = result.front.sides.size() >= 3;
        result.in_back = result.back.sides.size() >= 3;
        // The cut closes both halves, each seen from outside itself.
        result.front.sides.push_back({ plane_index ^ 1, nullptr, reversed(cut), true });
        result.back.sides.push_back({ plane_index, nullptr, cut, true });
    }

    const SourceMap& world_;
    const BrushModel& model_;
    Tree tree_;
};

} // namespace

int Tree::find_leaf(const PlaneSet& planes, const dvec3& p) const
{
    int index = 0;
    while (!nodes[size_t(index)].is_leaf()) {
        const Node& node = nodes[size_t(index)];
        index = node.children[planes[node.plane].distance(p) < 0];
    }
    return index;
}

Tree build_tree(const SourceMap& world, const BrushModel& model) { return TreeBuilder(world, model).build(); }

} // namespace vkpt::tools
