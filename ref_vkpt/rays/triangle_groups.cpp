// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/rays/triangle_groups.hpp"

#include "ref_vkpt/rays/binary_tree.hpp"
#include "ref_vkpt/rays/bvh.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace vkpt {

namespace {

Box box_of(const shared::Triangle& triangle)
{
    Box box;
    for (const glm::vec3& p : triangle.positions)
        box.add(p);
    return box;
}

// Orders `range` so that its halves, and theirs, are compact. The first half has the odd triangle.
class HalvingOrder {
public:
    HalvingOrder(std::span<const shared::Triangle> triangles, TriangleOrder order)
        : order_(order)
    {
        boxes_.reserve(triangles.size());
        for (const shared::Triangle& triangle : triangles)
            boxes_.push_back(box_of(triangle));
    }

    void sort(std::span<uint32_t> range)
    {
        if (range.size() < 3)
            return;
        const size_t half = (range.size() + 1) / 2;
        if (order_ == TriangleOrder::halves_quick)
            cut(range, half, longest_axis(range));
        else
            cut_cheapest(range, half);
        sort(range.first(half));
        sort(range.subspan(half));
    }

private:
    void cut(std::span<uint32_t> range, size_t half, int axis) const
    {
        const auto key = [&](uint32_t i) { return boxes_[i].low[axis] + boxes_[i].high[axis]; };
        std::nth_element(range.begin(), range.begin() + std::ptrdiff_t(half), range.end(), [&](uint32_t a, uint32_t b) {
            return key(a) != key(b) ? key(a) < key(b) : a < b; // a total order: runs are alike
        });
    }

    int longest_axis(std::span<const uint32_t> range) const
    {
        Box centres;
        for (const uint32_t i : range)
            centres.add(boxes_[i].centre());
        const glm::vec3 extent = centres.high - centres.low;
        return extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    }

    void cut_cheapest(std::span<uint32_t> range, size_t half)
    {
        float best_cost = std::numeric_limits<float>::max();
        int best_axis = 0, last_axis = 0;
        for (int axis = 0; axis < 3; axis++) {
            cut(range, half, axis);
            last_axis = axis;
            const float cost = area_of(range.first(half)) + area_of(range.subspan(half));
            if (cost < best_cost) {
                best_cost = cost;
                best_axis = axis;
            }
        }
        if (best_axis != last_axis)
            cut(range, half, best_axis);
    }

    float area_of(std::span<const uint32_t> range) const
    {
        Box box;
        for (const uint32_t i : range)
            box.add(boxes_[i]);
        return box.half_area();
    }

    TriangleOrder order_;
    std::vector<Box> boxes_;
};

bool is_usable(const TriangleSource& source, size_t i)
{
    BvhTriangle triangle;
    std::ranges::copy(source.triangles[i].positions, triangle.positions);
    triangle.id = source.first_id + uint32_t(i);
    return can_be_met(triangle);
}

} // namespace

GroupedTriangles group_triangles(const TriangleSource& source, TriangleOrder order)
{
    struct Key {
        uint32_t mask;
        bool has_holes;
        auto operator<=>(const Key&) const = default;
    };
    std::map<Key, std::vector<uint32_t>> members;
    for (size_t i = 0; i < source.triangles.size(); i++)
        if (is_usable(source, i))
            members[{ source.masks[i], source.has_holes[i] != 0 }].push_back(uint32_t(i));

    GroupedTriangles result;
    result.corners.reserve(source.triangles.size() * 3);
    result.ids.reserve(source.triangles.size());
    HalvingOrder halving(source.triangles, order);
    for (auto& [key, indices] : members) {
        if (order != TriangleOrder::as_given)
            halving.sort(indices);
        result.groups.push_back({ key.mask, key.has_holes, uint32_t(result.ids.size()), uint32_t(indices.size()) });
        for (const uint32_t i : indices) {
            result.corners.insert(result.corners.end(), std::begin(source.triangles[i].positions),
                std::end(source.triangles[i].positions));
            result.ids.push_back(source.first_id + i);
        }
    }
    return result;
}

} // namespace vkpt
