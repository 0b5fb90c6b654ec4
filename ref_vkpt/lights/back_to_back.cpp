// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/lights/back_to_back.hpp"

#include "ref_vkpt/lights/face_triangles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

namespace vkpt {

namespace {

using namespace formats;

constexpr float least_overlap = 0.25f; // units, in every direction
constexpr size_t pairs_per_face = 64;

struct PlaneFace {
    uint32_t face;
    bool is_front; // as in TurnedPlane
    std::vector<glm::vec3> outline;
    float first, last; // along one axis
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

// Those of one plane, marked where they overlap with one that looks the other way; `pairs` is what may yet be compared.
void mark_overlaps(std::vector<PlaneFace>& sides, const Bsp& bsp, size_t& pairs, std::vector<bool>& marked)
{
    std::ranges::sort(sides, {}, &PlaneFace::first);
    for (size_t i = 0; i < sides.size(); i++)
        for (size_t k = i + 1; k < sides.size() && sides[k].first < sides[i].last; k++) {
            if (pairs == 0)
                return;
            pairs--;
            if (sides[i].is_front == sides[k].is_front || (marked[sides[i].face] && marked[sides[k].face]))
                continue;
            const glm::vec3 normal = bsp.face_normal(sides[i].face);
            if (is_separated(sides[i].outline, sides[k].outline, normal)
                || is_separated(sides[k].outline, sides[i].outline, normal))
                continue;
            marked[sides[i].face] = marked[sides[k].face] = true;
        }
}

} // namespace

std::vector<bool> find_back_to_back(const Bsp& bsp)
{
    std::vector<bool> marked(bsp.faces.size());
    size_t pairs = pairs_per_face * bsp.faces.size();
    for (const BspModel& model : bsp.models) {
        std::map<PlaneKey, std::vector<PlaneFace>> planes;
        for (size_t face = size_t(model.first_face); face < size_t(model.first_face + model.face_count); face++) {
            std::vector<glm::vec3> outline = bsp.face_polygon(face);
            if (outline.size() < 3 || !is_drawn(bsp.texinfos[bsp.faces[face].texinfo]))
                continue;
            const glm::vec3 normal = bsp.face_normal(face);
            const TurnedPlane plane = plane_of(bsp, face);
            // Along an axis on which the plane is not seen edge on.
            const Extent extent
                = extent_along(outline, std::abs(normal.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0));
            planes[plane.key].push_back(
                { uint32_t(face), plane.is_front, std::move(outline), extent.least, extent.most });
        }
        for (auto& [key, sides] : planes)
            mark_overlaps(sides, bsp, pairs, marked);
    }
    return marked;
}

} // namespace vkpt
