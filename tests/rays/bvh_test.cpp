// SPDX-License-Identifier: GPL-2.0-or-later
// The builder alone: decodes what it wrote and checks what the traversal relies on.
#include "ref_vkpt/rays/bvh.hpp"
#include "ref_vkpt/rays/reinsertion.hpp"
#include "shaders/shared/trace.h"
#include "tests/rays/scenes.hpp"
#include "tests/rays/tree_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>

namespace vkpt::tests {
namespace {

using namespace shared;

// Everything that must hold for any input. `expected`: the ids that must be there, each as often as it is named.
void expect_sound(const Bvh& bvh, std::vector<uint32_t> expected)
{
    ASSERT_GE(bvh.node_count, 1u);
    ASSERT_EQ(bvh.nodes.size(), bvh.node_count * size_t(BVH_NODE_BYTES) / 4);
    ASSERT_GE(bvh.triangles.size(), bvh.triangle_count * size_t(BVH_TRIANGLE_BYTES) / 4);
    TreeCheck check(bvh);
    uint32_t need = check.check(0, 1).second;
    EXPECT_LE(need, TRACE_STACK_ENTRIES);
    EXPECT_TRUE(std::all_of(check.node_visits.begin(), check.node_visits.end(), [](uint32_t n) { return n == 1; }));
    EXPECT_TRUE(
        std::all_of(check.triangle_visits.begin(), check.triangle_visits.end(), [](uint32_t n) { return n == 1; }));
    std::vector<uint32_t> ids;
    for (uint32_t slot = 0; slot < bvh.triangle_count; slot++)
        ids.push_back(decode_triangle(bvh, slot).id_and_mask & BVH_ID_MASK);
    std::sort(ids.begin(), ids.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(ids, expected);
}

std::vector<uint32_t> ids_of(std::span<const BvhTriangle> triangles)
{
    std::vector<uint32_t> ids;
    for (const BvhTriangle& triangle : triangles)
        ids.push_back(triangle.id);
    return ids;
}

BvhTriangle small_triangle(glm::vec3 at, uint32_t id, float size = 1.0f)
{
    return { { at, at + glm::vec3(size, 0, 0), at + glm::vec3(0, size, 0) }, id, 1 };
}

class BuildBvh : public testing::TestWithParam<BvhQuality> {
protected:
    void expect_sound_tree_of(std::span<const BvhTriangle> triangles) const
    {
        expect_sound(build_bvh(triangles, GetParam()), ids_of(triangles));
    }
};
std::string quality_name(const testing::TestParamInfo<BvhQuality>& quality)
{
    return quality.param == BvhQuality::best ? "best" : "fast";
}
INSTANTIATE_TEST_SUITE_P(Quality, BuildBvh, testing::Values(BvhQuality::best, BvhQuality::fast), quality_name);

TEST_P(BuildBvh, makes_an_empty_tree_of_nothing)
{
    Bvh bvh = build_bvh({}, GetParam());
    expect_sound(bvh, {});
    EXPECT_EQ(bvh.triangle_count, 0u);
    EXPECT_EQ(bvh.node_count, 1u);
    EXPECT_FALSE(bvh.triangles.empty());
}

TEST_P(BuildBvh, keeps_a_single_triangle_as_it_is)
{
    BvhTriangle triangle { { { 1, 2, 3 }, { 5, 2, 4 }, { 1, 9, 3.5f } }, 0x123456, 0x85 };
    Bvh bvh = build_bvh(std::span(&triangle, 1), GetParam());
    expect_sound(bvh, { 0x123456 });
    DecodedTriangle decoded = decode_triangle(bvh, 0);
    for (int corner = 0; corner < 3; corner++)
        EXPECT_EQ(decoded.corners[corner], triangle.positions[corner]);
    EXPECT_EQ(decoded.id_and_mask, 0x85123456u);
}

TEST_P(BuildBvh, holds_every_count_up_to_a_few_nodes)
{
    Random random(1);
    for (size_t count = 1; count < 80; count++)
        expect_sound_tree_of(random_triangles(random, count, 64.0f));
}

TEST_P(BuildBvh, holds_a_hundred_thousand)
{
    Random random(2);
    expect_sound_tree_of(random_triangles(random, 100'000, 50.0f));
}

TEST_P(BuildBvh, holds_large_and_small_together)
{
    Random random(3);
    std::vector<BvhTriangle> triangles = random_triangles(random, 3000, 4000.0f);
    std::vector<BvhTriangle> small = random_triangles(random, 20'000, 0.01f, 3000);
    triangles.insert(triangles.end(), small.begin(), small.end());
    expect_sound_tree_of(triangles);
}

TEST_P(BuildBvh, holds_identical_triangles)
{
    std::vector<BvhTriangle> triangles;
    for (uint32_t id = 0; id < 50'000; id++)
        triangles.push_back(small_triangle(glm::vec3(7, -3, 11), id));
    expect_sound_tree_of(triangles);
}

// Each triangle twice as far out as the one before: what peels off one by one and would make the deepest tree.
TEST_P(BuildBvh, stays_walkable_on_exponential_spacing)
{
    std::vector<BvhTriangle> triangles;
    for (int axis = 0; axis < 3; axis++)
        for (int exponent = -90; exponent < 50; exponent++)
            for (int copy = 0; copy < 7; copy++) {
                glm::vec3 at(0.0f);
                at[axis] = std::ldexp(1.0f, exponent);
                triangles.push_back(small_triangle(at, uint32_t(triangles.size()), std::ldexp(1.0f, exponent - 6)));
            }
    std::vector<uint32_t> ids = ids_of(triangles);
    Bvh bvh = build_bvh(triangles, GetParam());
    // Among sizes from 2^-90 to 2^50 the grid's cells are coarse and edges vanish against corners: containment still
    // holds.
    expect_sound(bvh, ids);
}

TEST_P(BuildBvh, stays_walkable_on_nested_triangles)
{
    std::vector<BvhTriangle> triangles;
    for (uint32_t i = 0; i < 4000; i++) {
        float size = std::pow(1.01f, float(i % 2000)) * 1e-3f;
        triangles.push_back({ { { -size, -size, 0 }, { size, -size, 0 }, { 0, size, size } }, i, 1 });
    }
    expect_sound_tree_of(triangles);
}

// Nothing prunes the search for better places: without a bound the time grows with the square of the number.
TEST_P(BuildBvh, takes_bounded_time_for_nested_triangles)
{
    std::vector<BvhTriangle> triangles;
    for (uint32_t i = 0; i < 100'000; i++) {
        const float size = 1000 - 0.005f * float(i);
        triangles.push_back({ { { -size, -size, -size }, { size, -size, size }, { 0, size, size / 2 } }, i, 1 });
    }
    const std::clock_t start = std::clock(); // of the processor
    expect_sound_tree_of(triangles);
    EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 5);
}

TEST_P(BuildBvh, holds_a_flat_grid_and_a_line)
{
    std::vector<BvhTriangle> triangles;
    for (uint32_t i = 0; i < 10'000; i++)
        triangles.push_back(small_triangle(glm::vec3(float(i % 100), float(i / 100), 0), i));
    expect_sound_tree_of(triangles);
    for (uint32_t i = 0; i < 10'000; i++)
        triangles[i] = small_triangle(glm::vec3(float(i), 0, 0), i);
    expect_sound_tree_of(triangles);
}

TEST_P(BuildBvh, holds_what_lies_far_from_the_origin)
{
    std::vector<BvhTriangle> triangles;
    for (uint32_t i = 0; i < 500; i++)
        triangles.push_back(small_triangle(glm::vec3(1e6f + float(i % 25) * 8, -1e6f, float(i / 25)), i, 16.0f));
    expect_sound_tree_of(triangles);
}

TEST_P(BuildBvh, leaves_out_what_cannot_be_hit)
{
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    std::vector<BvhTriangle> triangles;
    for (float bad : { nan, infinity, -infinity, 1e30f })
        for (int corner = 0; corner < 3; corner++)
            for (int axis = 0; axis < 3; axis++) {
                triangles.push_back(small_triangle(glm::vec3(float(axis)), uint32_t(triangles.size())));
                triangles.back().positions[corner][axis] = bad;
            }
    triangles.push_back({ { { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } }, 1000, 1 }); // a point
    triangles.push_back({ { { 0, 0, 0 }, { 1, 2, 3 }, { 2, 4, 6 } }, 1001, 1 }); // a line
    triangles.push_back({ { { 0, 0, 0 }, { 5, 5, 5 }, { 0, 0, 0 } }, 1002, 1 }); // a line and back
    triangles.push_back(small_triangle(glm::vec3(3), BVH_ID_MASK + 1)); // no room for its id
    expect_sound(build_bvh(triangles, GetParam()), {});
    triangles.push_back(small_triangle(glm::vec3(9), 7));
    triangles.insert(triangles.begin(), small_triangle(glm::vec3(-9), BVH_ID_MASK));
    expect_sound(build_bvh(triangles, GetParam()), { 7, BVH_ID_MASK });
}

// Sum of the inner nodes' areas; checks that boxes, ranges and leaves belong together on the way.
double inner_area(const BinaryTree& tree, std::span<const Box> boxes, uint32_t node, std::vector<uint32_t>& uses)
{
    const BinaryNode& n = tree.nodes[node];
    Box expected;
    for (uint32_t i = n.first; i < n.first + n.count; i++)
        expected.add(boxes[tree.order[i]]);
    EXPECT_EQ(n.box.low, expected.low);
    EXPECT_EQ(n.box.high, expected.high);
    if (n.is_leaf()) {
        for (uint32_t i = n.first; i < n.first + n.count; i++)
            uses[tree.order[i]]++;
        return 0.0;
    }
    EXPECT_GT(n.left, node);
    EXPECT_GT(n.right, node);
    EXPECT_EQ(tree.nodes[n.left].count + tree.nodes[n.right].count, n.count);
    return double(n.box.half_area()) + inner_area(tree, boxes, n.left, uses) + inner_area(tree, boxes, n.right, uses);
}

TEST(AppendBvh, keeps_both_trees_whole)
{
    Random random(78);
    const std::vector<BvhTriangle> many = random_triangles(random, 700, 30, 0),
                                   few = random_triangles(random, 37, 5, 700);
    Bvh bvh = build_bvh(many, BvhQuality::best);
    const Bvh other = build_bvh(few, BvhQuality::best);
    const uint32_t root = append_bvh(bvh, other);
    EXPECT_EQ(root, bvh.node_count - other.node_count);
    EXPECT_EQ(bvh.triangle_count, 737u);
    TreeCheck first(bvh), second(bvh);
    first.check(0, 1);
    second.check(root, 1);
    for (uint32_t node = 0; node < bvh.node_count; node++) {
        EXPECT_EQ(first.node_visits[node], node < root ? 1u : 0u);
        EXPECT_EQ(second.node_visits[node], node < root ? 0u : 1u);
    }
    for (uint32_t slot = 0; slot < bvh.triangle_count; slot++) {
        const uint32_t id = decode_triangle(bvh, slot).id_and_mask & BVH_ID_MASK;
        EXPECT_EQ(first.triangle_visits[slot], id < 700 ? 1u : 0u);
        EXPECT_EQ(second.triangle_visits[slot], id < 700 ? 0u : 1u);
    }
}

TEST(Reinsertion, makes_boxes_smaller_and_keeps_the_tree_whole)
{
    Random random(77);
    std::vector<BvhTriangle> triangles = room(2048.0f, 8);
    for (auto [count, size] : { std::pair(40, 3000.0f), std::pair(2000, 200.0f), std::pair(6000, 20.0f) })
        std::ranges::copy(random_triangles(random, size_t(count), size, 0), std::back_inserter(triangles));
    std::vector<Box> boxes(triangles.size());
    for (size_t i = 0; i < triangles.size(); i++)
        for (const glm::vec3 p : triangles[i].positions)
            boxes[i].add(p);
    BinaryTree tree = build_sah(boxes, BVH_MAX_LEAF_TRIANGLES);
    std::vector<uint32_t> uses(boxes.size());
    const double before = inner_area(tree, boxes, 0, uses);
    const size_t nodes = tree.nodes.size();
    reinsert_subtrees(tree);
    std::ranges::fill(uses, 0);
    EXPECT_LT(inner_area(tree, boxes, 0, uses), 0.97 * before);
    EXPECT_TRUE(std::ranges::all_of(uses, [](uint32_t n) { return n == 1; }));
    EXPECT_EQ(tree.nodes.size(), nodes);
}

TEST(Reinsertion, leaves_small_trees_alone)
{
    const BvhTriangle triangle = small_triangle({ 1, 2, 3 }, 0);
    for (size_t count : { 0u, 1u, 5u, 9u }) {
        Box box;
        for (const glm::vec3 p : triangle.positions)
            box.add(p);
        const std::vector<Box> boxes(count, box); // all in one place: nowhere to go
        BinaryTree tree = build_sah(boxes, BVH_MAX_LEAF_TRIANGLES);
        const std::vector<uint32_t> order = tree.order;
        reinsert_subtrees(tree);
        EXPECT_EQ(tree.order, order);
    }
}

} // namespace
} // namespace vkpt::tests
