// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/rays/reference_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace vkpt::tests {

double PlaneCrossing::edge_distance() const { return std::min({ u, v, 1.0 - u - v }); }

PlaneCrossing cross_plane(const shared::TestRay& ray, const BvhTriangle& triangle)
{
    glm::dvec3 p0 = triangle.positions[0], p1 = triangle.positions[1], p2 = triangle.positions[2];
    glm::dvec3 origin = ray.origin, direction = ray.direction;
    glm::dvec3 normal = glm::cross(p1 - p0, p2 - p0);
    double slope = glm::dot(normal, direction);
    PlaneCrossing crossing;
    crossing.exists = std::abs(slope) > 0.0;
    if (!crossing.exists)
        return crossing;
    crossing.t = glm::dot(p0 - origin, normal) / slope;
    crossing.front = slope < 0.0;
    crossing.slope = std::abs(slope) / (glm::length(normal) * glm::length(direction));
    double longest = std::max({ glm::length(p1 - p0), glm::length(p2 - p1), glm::length(p0 - p2) });
    crossing.size = glm::length(normal) / longest;
    // Weights as ratios of areas, measured where the ray meets the plane.
    glm::dvec3 at = origin + direction * crossing.t;
    double area = glm::dot(normal, normal);
    crossing.u = glm::dot(glm::cross(p0 - p2, at - p2), normal) / area;
    crossing.v = glm::dot(glm::cross(p1 - p0, at - p0), normal) / area;
    return crossing;
}

ReferenceTracer::ReferenceTracer(std::span<const BvhTriangle> triangles)
    : triangles_(triangles)
    , order_(triangles.size())
{
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty())
        build(0, uint32_t(order_.size()));
}

void ReferenceTracer::build(uint32_t first, uint32_t count)
{
    Node node { glm::dvec3(std::numeric_limits<double>::max()), glm::dvec3(std::numeric_limits<double>::lowest()),
        first, count };
    for (uint32_t i = first; i < first + count; i++)
        for (glm::vec3 p : triangles_[order_[i]].positions) {
            node.low = glm::min(node.low, glm::dvec3(p));
            node.high = glm::max(node.high, glm::dvec3(p));
        }
    // So wide that no rounding matters.
    node.low -= 1e-3;
    node.high += 1e-3;
    size_t id = nodes_.size();
    nodes_.push_back(node);
    if (count <= 3)
        return;
    glm::dvec3 extent = node.high - node.low;
    int axis = extent.x > extent.y && extent.x > extent.z ? 0 : extent.y > extent.z ? 1 : 2;
    auto key = [&](uint32_t i) {
        const auto& p = triangles_[i].positions;
        return p[0][axis] + p[1][axis] + p[2][axis];
    };
    auto begin = order_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count, [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    build(first, count / 2);
    nodes_[id].right = uint32_t(nodes_.size());
    build(first + count / 2, count - count / 2);
}

void ReferenceTracer::try_triangle(
    const shared::TestRay& ray, uint32_t ray_mask, uint32_t triangle, ReferenceHit& best) const
{
    if (!(triangles_[triangle].mask & ray_mask))
        return;
    PlaneCrossing crossing = cross_plane(ray, triangles_[triangle]);
    bool nearer = best.triangle < 0 || crossing.t < best.crossing.t;
    if (crossing.exists && crossing.edge_distance() >= 0.0 && crossing.t > double(ray.t_min)
        && crossing.t < double(ray.t_max) && nearer)
        best = { triangle, crossing };
}

ReferenceHit ReferenceTracer::trace(const shared::TestRay& ray, uint32_t ray_mask) const
{
    ReferenceHit best;
    std::vector<uint32_t> open;
    if (!nodes_.empty())
        open.push_back(0);
    glm::dvec3 origin = ray.origin, inverse = 1.0 / glm::dvec3(ray.direction);
    while (!open.empty()) {
        uint32_t id = open.back();
        open.pop_back();
        const Node& node = nodes_[id];
        double enter = double(ray.t_min), leave = best.triangle < 0 ? double(ray.t_max) : best.crossing.t;
        bool outside = false;
        for (int axis = 0; axis < 3; axis++) {
            if (ray.direction[axis] == 0.0f) {
                outside |= origin[axis] < node.low[axis] || origin[axis] > node.high[axis];
                continue;
            }
            double a = (node.low[axis] - origin[axis]) * inverse[axis],
                   b = (node.high[axis] - origin[axis]) * inverse[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (outside || enter > leave)
            continue;
        if (node.right) {
            open.push_back(id + 1);
            open.push_back(node.right);
        } else {
            for (uint32_t i = node.first; i < node.first + node.count; i++)
                try_triangle(ray, ray_mask, order_[i], best);
        }
    }
    return best;
}

ReferenceHit ReferenceTracer::trace_slowly(const shared::TestRay& ray, uint32_t ray_mask) const
{
    ReferenceHit best;
    for (uint32_t i = 0; i < triangles_.size(); i++)
        try_triangle(ray, ray_mask, i, best);
    return best;
}

} // namespace vkpt::tests
