// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/rays/binary_tree.hpp"
#include "ref_vkpt/rays/triangle_groups.hpp"
#include "tests/rays/scenes.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <set>

namespace vkpt::tests {
namespace {

struct Sample {
    std::vector<shared::Triangle> triangles;
    std::vector<uint32_t> masks;
    std::vector<uint8_t> has_holes;
    TriangleSource source(uint32_t first_id = 0) const { return { triangles, masks, has_holes, first_id }; }
};

Sample make_sample(size_t count)
{
    Random random(3);
    Sample sample;
    for (const BvhTriangle& triangle : random_triangles(random, count, 40)) {
        shared::Triangle& added = sample.triangles.emplace_back();
        std::ranges::copy(triangle.positions, added.positions);
        sample.masks.push_back(1u << (random() % 3));
        sample.has_holes.push_back(random() % 4 == 0);
    }
    return sample;
}

constexpr TriangleOrder all_orders[]
    = { TriangleOrder::as_given, TriangleOrder::halves_quick, TriangleOrder::halves_best };

TEST(TriangleGroups, HoldEveryTriangleOnceWithItsOwnKind)
{
    constexpr uint32_t first_id = 1000;
    const Sample sample = make_sample(3000);
    for (const TriangleOrder order : all_orders) {
        const GroupedTriangles grouped = group_triangles(sample.source(first_id), order);
        EXPECT_EQ(grouped.groups.size(), 6u);
        EXPECT_EQ(std::set<uint32_t>(grouped.ids.begin(), grouped.ids.end()).size(), sample.triangles.size());
        EXPECT_EQ(grouped.corners.size(), grouped.ids.size() * 3);
        uint32_t next = 0;
        for (const TriangleGroup& group : grouped.groups) {
            EXPECT_EQ(group.first, next);
            EXPECT_GT(group.count, 0u);
            next += group.count;
            for (uint32_t slot = group.first; slot < next; slot++) {
                const size_t i = grouped.ids[slot] - first_id;
                ASSERT_LT(i, sample.triangles.size());
                EXPECT_EQ(sample.masks[i], group.mask);
                EXPECT_EQ(sample.has_holes[i] != 0, group.has_holes);
                for (size_t corner = 0; corner < 3; corner++)
                    EXPECT_EQ(grouped.corners[slot * 3 + corner], sample.triangles[i].positions[corner]);
            }
        }
        EXPECT_EQ(next, sample.triangles.size());
    }
}

TEST(TriangleGroups, LeaveOutWhatNoRayCanMeet)
{
    Sample sample = make_sample(5);
    sample.triangles[1].positions[2] = sample.triangles[1].positions[0];
    sample.triangles[2].positions[0].x = std::numeric_limits<float>::quiet_NaN();
    sample.triangles[3].positions[1].y = std::numeric_limits<float>::infinity();
    for (const TriangleOrder order : all_orders) {
        const GroupedTriangles grouped = group_triangles(sample.source(), order);
        EXPECT_EQ(std::set<uint32_t>(grouped.ids.begin(), grouped.ids.end()), (std::set<uint32_t> { 0, 4 }));
    }
    EXPECT_TRUE(group_triangles({}, TriangleOrder::halves_best).groups.empty());
}

// Areas of the boxes of a tree that halves by index, as the driver's does.
double halving_cost(std::span<const glm::vec3> corners)
{
    Box box;
    for (const glm::vec3& p : corners)
        box.add(p);
    const size_t count = corners.size() / 3;
    if (count < 2)
        return double(box.half_area());
    const size_t half = (count + 1) / 2 * 3;
    return double(box.half_area()) + halving_cost(corners.first(half)) + halving_cost(corners.subspan(half));
}

TEST(TriangleGroups, AreOrderedSoThatHalvesAreCompact)
{
    Sample sample = make_sample(4000);
    std::ranges::fill(sample.masks, 1u);
    std::ranges::fill(sample.has_holes, uint8_t(0));
    double costs[3];
    for (int i = 0; i < 3; i++)
        costs[i] = halving_cost(group_triangles(sample.source(), all_orders[i]).corners);
    EXPECT_LT(costs[1], costs[0] / 4);
    EXPECT_LE(costs[2], costs[1] * 1.02);
}

} // namespace
} // namespace vkpt::tests
