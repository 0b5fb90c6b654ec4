// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/map_compiler/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace vkpt::tools {

namespace {

constexpr double normal_epsilon = 1e-5;
constexpr double dist_epsilon = 0.01;

int major_axis(const dvec3& normal)
{
    const dvec3 a = glm::abs(normal);
    return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}

long distance_bucket(double dist) { return std::lround(std::floor(std::abs(dist) / 8.0)); }

void snap(dvec3& normal, double& dist)
{
    for (int axis = 0; axis < 3; axis++)
        if (std::abs(std::abs(normal[axis]) - 1.0) < normal_epsilon) {
            const double sign = normal[axis] > 0 ? 1.0 : -1.0;
            normal = dvec3(0);
            normal[axis] = sign;
            break;
        }
    if (std::abs(dist - std::round(dist)) < dist_epsilon)
        dist = std::round(dist);
}

bool same(const Plane& plane, const dvec3& normal, double dist)
{
    return std::abs(plane.dist - dist) < dist_epsilon && std::abs(plane.normal.x - normal.x) < normal_epsilon
        && std::abs(plane.normal.y - normal.y) < normal_epsilon && std::abs(plane.normal.z - normal.z) < normal_epsilon;
}

} // namespace

int PlaneSet::find(dvec3 normal, double dist)
{
    snap(normal, dist);
    const long bucket = distance_bucket(dist);
    for (long key = bucket - 1; key <= bucket + 1; key++) {
        const auto [first, last] = by_distance_.equal_range(key);
        for (auto it = first; it != last; ++it)
            if (same(planes_[size_t(it->second)], normal, dist))
                return it->second;
    }
    const int axis = major_axis(normal);
    const bool axial = std::abs(normal[axis]) == 1.0;
    const Plane plane { normal, dist, axial ? axis : axis + 3 };
    const bool positive = normal[axis] > 0;
    const int first = int(planes_.size());
    planes_.push_back(positive ? plane : plane.flipped());
    planes_.push_back(positive ? plane.flipped() : plane);
    by_distance_.emplace(bucket, first);
    by_distance_.emplace(bucket, first + 1);
    return positive ? first : first + 1;
}

Winding make_base_winding(const Plane& plane)
{
    const int axis = major_axis(plane.normal);
    dvec3 up = axis == 2 ? dvec3(1, 0, 0) : dvec3(0, 0, 1);
    up = glm::normalize(up - plane.normal * glm::dot(up, plane.normal));
    const dvec3 right = glm::cross(up, plane.normal);
    const dvec3 centre = plane.normal * plane.dist;
    const double size = world_limit * 4;
    return { centre + (up - right) * size, centre + (up + right) * size, centre + (right - up) * size,
        centre - (up + right) * size };
}

SplitWinding split_winding(const Winding& winding, const Plane& plane, double epsilon)
{
    SplitWinding result;
    const size_t count = winding.size();
    std::vector<double> d(count);
    bool any_front = false, any_back = false;
    for (size_t i = 0; i < count; i++) {
        d[i] = plane.distance(winding[i]);
        any_front |= d[i] > epsilon;
        any_back |= d[i] < -epsilon;
    }
    if (!any_front || !any_back) {
        result.on = !any_front && !any_back;
        if (any_front)
            result.front = winding;
        if (any_back)
            result.back = winding;
        return result;
    }
    for (size_t i = 0; i < count; i++) {
        const size_t next = (i + 1) % count;
        if (d[i] >= -epsilon)
            result.front.push_back(winding[i]);
        if (d[i] <= epsilon)
            result.back.push_back(winding[i]);
        const bool crosses = (d[i] > epsilon && d[next] < -epsilon) || (d[i] < -epsilon && d[next] > epsilon);
        if (!crosses)
            continue;
        dvec3 mid = winding[i] + (winding[next] - winding[i]) * (d[i] / (d[i] - d[next]));
        for (int axis = 0; axis < 3; axis++)
            if (std::abs(plane.normal[axis]) == 1.0)
                mid[axis] = plane.dist * plane.normal[axis];
        result.front.push_back(mid);
        result.back.push_back(mid);
    }
    return result;
}

Winding clip_winding(const Winding& winding, const Plane& plane, double epsilon, bool keep_on)
{
    SplitWinding split = split_winding(winding, plane, epsilon);
    if (split.on && keep_on)
        return winding;
    return std::move(split.front);
}

double winding_area(const Winding& winding)
{
    dvec3 sum(0);
    for (size_t i = 2; i < winding.size(); i++)
        sum += glm::cross(winding[i - 1] - winding[0], winding[i] - winding[0]);
    return 0.5 * glm::length(sum);
}

dvec3 winding_centre(const Winding& winding)
{
    dvec3 sum(0);
    for (const dvec3& p : winding)
        sum += p;
    return winding.empty() ? sum : sum / double(winding.size());
}

bool is_tiny(const Winding& winding)
{
    constexpr double visible_edge = 0.2;
    int edges = 0;
    for (size_t i = 0; i < winding.size(); i++)
        edges += glm::distance(winding[i], winding[(i + 1) % winding.size()]) > visible_edge;
    return edges < 3;
}

Plane winding_plane(const Winding& winding)
{
    dvec3 sum(0);
    for (size_t i = 2; i < winding.size(); i++)
        sum += glm::cross(winding[i] - winding[0], winding[i - 1] - winding[0]);
    const dvec3 normal = glm::normalize(sum);
    return { normal, glm::dot(normal, winding[0]), major_axis(normal) + 3 };
}

Winding reversed(const Winding& winding) { return { winding.rbegin(), winding.rend() }; }

} // namespace vkpt::tools
