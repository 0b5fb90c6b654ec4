// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/truth/ray_tree.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

namespace vkpt::truth {

namespace {

constexpr uint32_t leaf_size = 4;
constexpr size_t max_depth = 64;

// Moeller and Trumbore 1997, both sides.
bool meet(const Triangle& triangle, dvec3 origin, dvec3 direction, RayHit& hit)
{
    const dvec3 e1 = triangle.positions[1] - triangle.positions[0], e2 = triangle.positions[2] - triangle.positions[0];
    const dvec3 p = glm::cross(direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0)
        return false;
    const dvec3 from = origin - triangle.positions[0], q = glm::cross(from, e1);
    const double b1 = glm::dot(from, p) / determinant, b2 = glm::dot(direction, q) / determinant;
    const double t = glm::dot(e2, q) / determinant;
    if (!(b1 >= 0 && b2 >= 0 && b1 + b2 <= 1 && t > 0 && t < hit.t))
        return false;
    hit.t = t;
    hit.b1 = b1;
    hit.b2 = b2;
    return true;
}

} // namespace

RayTree::RayTree(const std::vector<Triangle>& triangles)
    : triangles_(triangles)
    , order_(triangles.size())
{
    std::iota(order_.begin(), order_.end(), 0u);
    for (const Triangle& triangle : triangles)
        centres_.push_back((triangle.positions[0] + triangle.positions[1] + triangle.positions[2]) / 3.0);
    build(0, uint32_t(order_.size()));
}

void RayTree::build(uint32_t first, uint32_t count)
{
    const size_t index = nodes_.size();
    nodes_.emplace_back();
    Node node;
    for (uint32_t i = first; i < first + count; i++)
        for (const dvec3& corner : triangles_[order_[i]].positions) {
            node.mins = glm::min(node.mins, corner);
            node.maxs = glm::max(node.maxs, corner);
        }
    if (count <= leaf_size) {
        node.first = first;
        node.count = count;
        nodes_[index] = node;
        return;
    }
    const dvec3 size = node.maxs - node.mins;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count,
        [&](uint32_t a, uint32_t b) { return centres_[a][axis] < centres_[b][axis]; });
    build(first, count / 2);
    node.second = uint32_t(nodes_.size());
    nodes_[index] = node;
    build(first + count / 2, count - count / 2);
}

// `visit` gets the triangles of leaves that the ray meets before t_max, which it may lower, and returns true to end.
template <class Visit> void RayTree::visit_leaves(dvec3 origin, dvec3 direction, const double& t_max, Visit visit) const
{
    const dvec3 inverse = 1.0 / direction;
    std::array<uint32_t, max_depth> stack;
    size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const uint32_t index = stack[--depth];
        const Node& node = nodes_[index];
        const dvec3 a = (node.mins - origin) * inverse, b = (node.maxs - origin) * inverse;
        const dvec3 near = glm::min(a, b), far = glm::max(a, b);
        const double enter = std::max({ near.x, near.y, near.z, 0.0 }),
                     leave = std::min({ far.x, far.y, far.z, t_max });
        if (enter > leave * (1 + 1e-12))
            continue;
        for (uint32_t i = node.first; i < node.first + node.count; i++)
            if (visit(order_[i]))
                return;
        if (node.count == 0) {
            stack[depth++] = node.second;
            stack[depth++] = index + 1;
        }
    }
}

RayHit RayTree::find_nearest(dvec3 origin, dvec3 direction, double t_max, uint32_t mask) const
{
    RayHit hit;
    hit.t = t_max;
    visit_leaves(origin, direction, hit.t, [&](uint32_t triangle) {
        if (triangles_[triangle].ray_mask & mask && meet(triangles_[triangle], origin, direction, hit))
            hit.triangle = int(triangle);
        return false;
    });
    return hit;
}

bool RayTree::is_blocked(dvec3 origin, dvec3 direction, double t_max, uint32_t mask) const
{
    RayHit hit;
    hit.t = t_max;
    bool blocked = false;
    visit_leaves(origin, direction, hit.t, [&](uint32_t triangle) {
        blocked = triangles_[triangle].ray_mask & mask && meet(triangles_[triangle], origin, direction, hit);
        return blocked;
    });
    return blocked;
}

} // namespace vkpt::truth
