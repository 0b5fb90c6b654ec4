// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/map_compiler/faces.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace vkpt::tools {

using namespace formats;

namespace {

// Joins two polygons of one plane along a common edge, if the result is convex. Empty: they do not fit.
Winding merge_windings(const Winding& a, const Winding& b, const dvec3& normal)
{
    const auto same = [](const dvec3& p, const dvec3& q) { return glm::distance(p, q) < 0.02; };
    const size_t na = a.size(), nb = b.size();
    size_t ia = 0, ib = 0;
    bool found = false;
    for (size_t i = 0; i < na && !found; i++)
        for (size_t k = 0; k < nb && !found; k++)
            if (same(a[i], b[(k + 1) % nb]) && same(a[(i + 1) % na], b[k])) {
                ia = i;
                ib = k;
                found = true;
            }
    if (!found)
        return {};
    // Corners where the two meet: clockwise polygons turn right everywhere. -1 concave, 0 straight, 1 convex.
    const auto turn = [&](const dvec3& before, const dvec3& at, const dvec3& after) {
        const dvec3 right = glm::cross(glm::normalize(at - before), normal);
        const double d = glm::dot(glm::normalize(after - at), right);
        return d > 1e-4 ? 1 : d < -1e-4 ? -1 : 0;
    };
    const int start_turn = turn(a[(ia + na - 1) % na], a[ia], b[(ib + 2) % nb]);
    const int end_turn = turn(b[(ib + nb - 1) % nb], b[ib], a[(ia + 2) % na]);
    if (start_turn < 0 || end_turn < 0)
        return {};
    Winding result;
    for (size_t i = 1; i <= na; i++) { // from the shared edge's end round to its start
        const size_t at = (ia + i) % na;
        if ((i == 1 && end_turn == 0) || (i == na && start_turn == 0))
            continue;
        result.push_back(a[at]);
    }
    for (size_t k = 2; k < nb; k++)
        result.push_back(b[(ib + k) % nb]);
    return result;
}

// The file holds 65,535 faces; those that were merged and divided are here, too.
constexpr size_t max_faces = 65535, max_faces_with_replaced = 8 * max_faces;

class FaceMaker {
public:
    FaceMaker(Tree& tree, const SourceMap& world)
        : tree_(tree)
        , world_(world)
    {
    }

    FaceSet make()
    {
        for (size_t i = 0; i < tree_.portals.size(); i++)
            make_portal_faces(tree_.portals[i]);
        for (Node& node : tree_.nodes) {
            merge_node(node);
            cut_node(node);
        }
        fix_t_junctions();
        return std::move(set_);
    }

private:
    Face& face(int index) { return set_.faces[size_t(index)]; }

    void make_portal_faces(Portal& portal)
    {
        if (portal.winding.empty() || !portal.side || portal.on_node < 0)
            return;
        const uint32_t flags = world_.texinfos[size_t(portal.side->texinfo)].flags;
        // Not seen; kept where it shines, for the lights.
        if (flags & (SURF_SKIP | SURF_HINT) || (flags & SURF_NODRAW && !(flags & (SURF_LIGHT | SURF_SKY))))
            return;
        for (int side = 0; side < 2; side++) {
            const uint32_t here = tree_.nodes[size_t(portal.nodes[side])].contents;
            const uint32_t there = tree_.nodes[size_t(portal.nodes[side ^ 1])].contents;
            if (here & CONTENTS_SOLID)
                continue;
            if (here & CONTENTS_WINDOW && visible_contents(here ^ there) == CONTENTS_WINDOW)
                continue; // glass is not seen from inside
            portal.faces[side] = add_face(portal, side, here);
        }
    }

    int add_face(const Portal& portal, int side, uint32_t contents)
    {
        Face f;
        f.plane = portal.plane ^ side;
        f.texinfo = portal.side->texinfo;
        f.line = portal.side->line;
        f.node = portal.on_node;
        f.winding = side == 0 ? portal.winding : reversed(portal.winding);
        f.contents = contents & visible_contents_mask;
        const int index = int(set_.faces.size());
        set_.faces.push_back(std::move(f));
        tree_.nodes[size_t(portal.on_node)].faces.push_back(index);
        return index;
    }

    void merge_node(Node& node)
    {
        for (size_t i = 0; i < node.faces.size(); i++)
            for (size_t k = 0; k < i; k++) {
                const int merged = try_merge(node.faces[i], node.faces[k]);
                if (merged < 0)
                    continue;
                node.faces.erase(node.faces.begin() + long(i));
                node.faces.erase(node.faces.begin() + long(k));
                node.faces.push_back(merged);
                i = size_t(-1); // the new one may fit an earlier one
                break;
            }
    }

    int try_merge(int a, int b)
    {
        const Face &fa = face(a), &fb = face(b);
        if (fa.plane != fb.plane || fa.texinfo != fb.texinfo || fa.contents != fb.contents)
            return -1;
        Winding winding = merge_windings(fa.winding, fb.winding, world_.planes[fa.plane].normal);
        if (winding.size() < 3)
            return -1;
        Face merged = fa;
        merged.winding = std::move(winding);
        const int index = int(set_.faces.size());
        set_.faces.push_back(std::move(merged));
        face(a).replaced_by = { index };
        face(b).replaced_by = { index };
        return index;
    }

    void cut_node(Node& node)
    {
        std::vector<int> done;
        while (!node.faces.empty()) {
            const int index = node.faces.back();
            node.faces.pop_back();
            check_piece_count(face(index));
            if (const auto plane = find_cut(face(index)))
                cut_face(index, *plane, node.faces);
            else
                done.push_back(index);
        }
        std::ranges::reverse(done);
        node.faces = std::move(done);
    }

    bool has_lightmap(const Face& f) const
    {
        return !(world_.texinfos[size_t(f.texinfo)].flags & (SURF_WARP | SURF_SKY));
    }

    // The face along one of its texture's axes.
    struct Extent {
        dvec3 axis;
        double offset, low, high;
        bool is_full() const { return glm::length(axis) >= 1e-9 && high - low > max_face_texels + 0.1; }
    };
    Extent find_extent(const Face& f, int i) const
    {
        const BspTexinfo& info = world_.texinfos[size_t(f.texinfo)];
        Extent extent { dvec3(i == 0 ? info.s_axis : info.t_axis), i == 0 ? info.s_offset : info.t_offset, 1e30,
            -1e30 };
        for (const dvec3& p : f.winding) {
            const double texel = glm::dot(p, extent.axis) + extent.offset;
            extent.low = std::min(extent.low, texel);
            extent.high = std::max(extent.high, texel);
        }
        return extent;
    }

    // The plane across the face at which its lightmap is full; on a luxel line, so that no luxel is shared.
    std::optional<Plane> find_cut(const Face& f) const
    {
        for (int i = 0; i < 2 && has_lightmap(f); i++) {
            const Extent extent = find_extent(f, i);
            if (!extent.is_full())
                continue;
            const double cut = 16.0 * std::floor((extent.low + max_face_texels) / 16.0),
                         length = glm::length(extent.axis);
            return Plane { extent.axis / length, (cut - extent.offset) / length, 3 };
        }
        return {};
    }

    // Before a face is divided into more pieces than the file can hold.
    void check_piece_count(const Face& f) const
    {
        double pieces = 1;
        for (int i = 0; i < 2 && has_lightmap(f); i++)
            if (const Extent extent = find_extent(f, i); extent.is_full())
                pieces *= (extent.high - extent.low) / max_face_texels;
        if (!(pieces <= double(max_faces)) || set_.faces.size() > max_faces_with_replaced)
            world_.source.fail(f.line,
                fmt::format(
                    "the lightmaps of this side, or of all together, need more than the format's {} faces; give the "
                    "texture a larger scale",
                    max_faces));
    }

    void cut_face(int index, const Plane& plane, std::vector<int>& pending)
    {
        SplitWinding split = split_winding(face(index).winding, plane, 0.001);
        if (split.front.size() < 3 || split.back.size() < 3)
            world_.source.fail(face(index).line,
                "the side is too narrow to be divided for its lightmap; give the texture a larger scale");
        const Face original = face(index);
        std::vector<int> parts;
        for (Winding* winding : { &split.front, &split.back }) {
            Face part = original;
            part.winding = std::move(*winding);
            parts.push_back(int(set_.faces.size()));
            set_.faces.push_back(std::move(part));
        }
        pending.insert(pending.end(), parts.begin(), parts.end());
        face(index).replaced_by = std::move(parts);
    }

    // Adds to every edge the corners of other faces that lie on it.
    void fix_t_junctions()
    {
        std::vector<dvec3> corners;
        for (const Node& node : tree_.nodes)
            for (const int index : node.faces)
                corners.insert(corners.end(), face(index).winding.begin(), face(index).winding.end());
        std::ranges::sort(corners, {}, &dvec3::x);
        for (const Node& node : tree_.nodes)
            for (const int index : node.faces)
                face(index).winding = best_rotation(with_corners(face(index).winding, corners));
    }

    static Winding with_corners(const Winding& winding, const std::vector<dvec3>& corners)
    {
        constexpr double tolerance = 0.05;
        Winding result;
        for (size_t i = 0; i < winding.size(); i++) {
            const dvec3 a = winding[i], b = winding[(i + 1) % winding.size()];
            result.push_back(a);
            const double length = glm::distance(a, b);
            if (length < 2 * tolerance)
                continue;
            const dvec3 direction = (b - a) / length;
            const double low = std::min(a.x, b.x) - tolerance, high = std::max(a.x, b.x) + tolerance;
            std::vector<double> stops;
            for (auto it = std::ranges::lower_bound(corners, low, {}, &dvec3::x); it != corners.end() && it->x <= high;
                 ++it) {
                const double along = glm::dot(*it - a, direction);
                if (along > tolerance && along < length - tolerance
                    && glm::distance(*it, a + direction * along) < tolerance)
                    stops.push_back(along);
            }
            std::ranges::sort(stops);
            double last = 0;
            for (const double along : stops)
                if (along - last > tolerance) {
                    result.push_back(a + direction * along);
                    last = along;
                }
        }
        return result;
    }

    // Renderers draw the polygon as a fan from its first corner: start where fewest triangles have no area.
    static Winding best_rotation(const Winding& winding)
    {
        const size_t count = winding.size();
        size_t best = 0, best_flat = count + 1;
        for (size_t start = 0; start < count; start++) {
            size_t flat = 0;
            for (size_t i = 1; i + 1 < count; i++) {
                const dvec3 &a = winding[start], &b = winding[(start + i) % count],
                            &c = winding[(start + i + 1) % count];
                flat += glm::length(glm::cross(b - a, c - a)) < 0.01 * glm::distance(b, c);
            }
            if (flat < best_flat) {
                best_flat = flat;
                best = start;
            }
        }
        Winding result(winding);
        std::rotate(result.begin(), result.begin() + long(best), result.end());
        return result;
    }

    Tree& tree_;
    const SourceMap& world_;
    FaceSet set_;
};

} // namespace

void FaceSet::collect(int face, std::vector<int>& result) const
{
    // Not recursive: a face that is cut into thousands is cut piece by piece.
    for (std::vector<int> pending { face }; !pending.empty();) {
        const Face& f = faces[size_t(pending.back())];
        if (f.replaced_by.empty())
            result.push_back(pending.back());
        pending.pop_back();
        pending.insert(pending.end(), f.replaced_by.rbegin(), f.replaced_by.rend());
    }
}

FaceSet make_faces(Tree& tree, const SourceMap& world) { return FaceMaker(tree, world).make(); }

} // namespace vkpt::tools
