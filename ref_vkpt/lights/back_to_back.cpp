// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/back_to_back.hpp"

#include "ref_vkpt/lights/face_triangles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <map>

namespace vkpt {

namespace {

using namespace formats;

constexpr float least_overlap = 0.25f; // units, in every direction
// Comparisons of corners that each corner of the map may take: real maps take 1 to 6, made-up ones
// must end.
constexpr size_t work_per_corner = 256;

struct PlaneFace {
    uint32_t face;
    bool is_front; // as in TurnedPlane
    std::vector<glm::vec3> outline;
    glm::vec3 mins, maxs;
};

// The same for all faces of a plane: its normal, turned so that the largest component is positive, and its distance.
// The map has both sides of a plane in the same numbers, so little is lost by rounding.
using PlaneKey = std::array<int64_t, 4>;

struct TurnedPlane {
    PlaneKey key;
    bool is_front; // the face looks along that normal
};

TurnedPlane plane_of(const Bsp& bsp, size_t face)
{
    const BspPlane& plane = bsp.planes[bsp.faces[face].plane];
    const glm::vec3 size = glm::abs(plane.normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const double sign = plane.normal[axis] < 0 ? -1 : 1;
    const auto whole = [](double x) { return std::isfinite(x) ? std::llround(std::clamp(x, -1e12, 1e12)) : 0; };
    PlaneKey key { 0, 0, 0, whole(sign * double(plane.dist) * 16) };
    for (int i = 0; i < 3; i++)
        key[size_t(i)] = whole(sign * double(plane.normal[i]) * 4096);
    return { key, (sign > 0) == (bsp.faces[face].side == 0) };
}

struct Extent {
    float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
};

Extent extent_along(const std::vector<glm::vec3>& outline, glm::vec3 way)
{
    Extent extent;
    for (const glm::vec3 corner : outline) {
        extent.least = std::min(extent.least, glm::dot(corner, way));
        extent.most = std::max(extent.most, glm::dot(corner, way));
    }
    return extent;
}

// Whether an edge of `a` has all of `b` beyond it, or nearly so. Both are convex and in the plane with that normal.
bool is_separated(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b, glm::vec3 normal)
{
    for (size_t i = 0; i < a.size(); i++) {
        const glm::vec3 across = glm::cross(normal, a[(i + 1) % a.size()] - a[i]);
        const float length = glm::length(across);
        if (!(length > 1e-3f))
            continue;
        const Extent one = extent_along(a, across / length), other = extent_along(b, across / length);
        if (std::min(one.most, other.most) - std::max(one.least, other.least) < least_overlap)
            return true;
    }
    return false;
}

// What may yet be done. Not a WorkLimit: a map that has many faces in one plane is no reason to refuse it.
class Work {
public:
    explicit Work(const Bsp& bsp)
        : left_(work_per_corner * bsp.surface_edges.size())
    {
    }
    // False: too much.
    bool spend(size_t comparisons)
    {
        left_ -= std::min(left_, comparisons);
        return left_ > 0;
    }

private:
    size_t left_;
};

// Those of one plane, marked where they overlap with one that looks the other way. `axis`: one along which the plane
// extends.
void mark_overlaps(
    std::vector<PlaneFace>& sides, const Bsp& bsp, glm::length_t axis, Work& work, std::vector<bool>& marked)
{
    std::ranges::sort(sides, {}, [axis](const PlaneFace& side) { return side.mins[axis]; });
    for (size_t i = 0; i < sides.size(); i++)
        for (size_t k = i + 1; k < sides.size() && sides[k].mins[axis] < sides[i].maxs[axis]; k++) {
            const PlaneFace &a = sides[i], &b = sides[k];
            if (!work.spend(1))
                return;
            if (a.is_front == b.is_front || (marked[a.face] && marked[b.face])
                || glm::any(glm::lessThan(glm::min(a.maxs, b.maxs), glm::max(a.mins, b.mins))))
                continue;
            const size_t corners = a.outline.size() + b.outline.size();
            if (!work.spend(corners * corners))
                return;
            const glm::vec3 normal = bsp.face_normal(a.face);
            if (!is_separated(a.outline, b.outline, normal) && !is_separated(b.outline, a.outline, normal))
                marked[a.face] = marked[b.face] = true;
        }
}

} // namespace

std::vector<bool> find_back_to_back(const Bsp& bsp)
{
    std::vector<bool> marked(bsp.faces.size());
    Work work(bsp);
    for (const BspModel& model : bsp.models) {
        std::map<PlaneKey, std::vector<PlaneFace>> planes;
        for (size_t face = size_t(model.first_face); face < size_t(model.first_face + model.face_count); face++) {
            std::vector<glm::vec3> outline = bsp.face_polygon(face);
            if (!work.spend(outline.size())) // models of a broken map may share their faces
                return marked;
            if (outline.size() < 3 || !is_drawn(bsp.texinfos[bsp.faces[face].texinfo]))
                continue;
            PlaneFace side { uint32_t(face), false, std::move(outline), glm::vec3(1e30f), glm::vec3(-1e30f) };
            for (const glm::vec3 corner : side.outline) {
                side.mins = glm::min(side.mins, corner);
                side.maxs = glm::max(side.maxs, corner);
            }
            const TurnedPlane plane = plane_of(bsp, face);
            side.is_front = plane.is_front;
            planes[plane.key].push_back(std::move(side));
        }
        for (auto& [key, sides] : planes)
            mark_overlaps(sides, bsp, std::abs(bsp.face_normal(sides[0].face).x) < 0.7f ? 0 : 1, work, marked);
    }
    return marked;
}

} // namespace vkpt
