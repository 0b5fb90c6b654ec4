// SPDX-License-Identifier: GPL-2.0-or-later
#include "lamp_hall.hpp"
#include "ref_vkpt/lights/light_source.hpp"
#include "ref_vkpt/lights/light_trees.hpp"
#include "sampler_case.hpp"
#include "sampler_lists.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <numeric>

namespace vkpt::test {
namespace {

using shared::Emitter;
using shared::LightTreeNode;

LightTrees make_trees(const LampHall& hall)
{
    return make_light_trees(hall.lists.lists(), hall.lists.static_indices(), hall.lamps);
}

// Of one list that is all of `indices`.
LightTrees make_tree(std::span<const uint32_t> indices, std::span<const Emitter> emitters)
{
    const shared::LightList list { 0, uint32_t(indices.size()), 0, 0 };
    return make_light_trees(std::span(&list, 1), indices, emitters);
}

// What lies in a node: its lights follow one another in the tree's order.
struct Part {
    size_t node, first, count, depth;
};

// All nodes of a list's tree, the root first.
std::vector<Part> walk(const LightTrees& trees, size_t root, size_t count)
{
    std::vector<Part> parts { { root, 0, count, 0 } };
    for (size_t i = 0; i < parts.size(); i++) {
        const Part part = parts[i];
        const LightTreeNode& node = trees.nodes.at(part.node);
        if (node.second == 0)
            continue;
        parts.push_back({ part.node + 1, part.first, node.first_count, part.depth + 1 });
        parts.push_back(
            { part.node + node.second, part.first + node.first_count, part.count - node.first_count, part.depth + 1 });
    }
    return parts;
}

void expect_bounded(const LightTreeNode& node, const Emitter& e)
{
    const LightSource source = make_light_source(e);
    if (e.type == shared::EMITTER_SPHERE) {
        EXPECT_LE(glm::length(e.p0 - node.centre) + e.p1.x, node.radius * 1.0001f);
        if (source.normal == glm::vec3(0)) // shines to all sides; else it is a spot
            EXPECT_EQ(node.cone_cosine, -1);
        else
            EXPECT_GE(glm::dot(source.normal, node.axis), node.cone_cosine);
        return;
    }
    for (const glm::vec3 corner : { e.p0, e.p1, e.p2 })
        EXPECT_LE(glm::length(corner - node.centre), node.radius);
    EXPECT_GE(glm::dot(source.normal, node.axis), node.cone_cosine);
}

void expect_sound(const LightTrees& trees, size_t list, size_t first, std::span<const uint32_t> indices,
    std::span<const Emitter> emitters)
{
    // The lights are the list's, each once, and each place leads to its own.
    for (size_t place = 0; place < indices.size(); place++)
        ASSERT_EQ(trees.lights.at(first + trees.places.at(first + place)), indices[place]);
    const std::vector<Part> parts = walk(trees, trees.roots.at(list), indices.size());
    size_t in_leaves = 0;
    for (const Part& part : parts) {
        const LightTreeNode& node = trees.nodes[part.node];
        double power = 0;
        ASSERT_GT(part.count, 0u);
        for (size_t i = part.first; i < part.first + part.count; i++) {
            expect_bounded(node, emitters[trees.lights[first + i]]);
            power += double(make_light_source(emitters[trees.lights[first + i]]).power);
        }
        EXPECT_NEAR(node.power, power, 1e-4 * power);
        EXPECT_NEAR(glm::length(node.axis), 1, 1e-4);
        EXPECT_LE(part.depth, 3 + size_t(std::log(double(indices.size())) / std::log(4.0 / 3)));
        if (node.second == 0) {
            EXPECT_LE(part.count, shared::LIGHT_TREE_LEAF);
            in_leaves += part.count;
        }
    }
    EXPECT_EQ(in_leaves, indices.size());
}

TEST(LightTrees, HoldWhatTheyBound)
{
    const LampHall hall(700);
    const LightTrees trees = make_trees(hall);
    ASSERT_EQ(trees.roots.size(), hall.lists.lists().size());
    for (size_t i = 0; i < trees.roots.size(); i++) {
        const shared::LightList& list = hall.lists.lists()[i];
        expect_sound(trees, i, list.first_static,
            std::span(hall.lists.static_indices()).subspan(list.first_static, list.static_count), hall.lamps);
    }
}

TEST(LightTrees, HoldSpheresDarkLightsAndOnesInOnePlace)
{
    for (const uint32_t seed : { 1, 2, 3 }) {
        ListCase scene = make_random_list(300, 0.2, seed);
        scene.emitters.resize(330, scene.emitters[7]);
        std::vector<uint32_t> indices(scene.emitters.size());
        std::iota(indices.begin(), indices.end(), 0u);
        expect_sound(make_tree(indices, scene.emitters), 0, 0, indices, scene.emitters);
    }
    EXPECT_TRUE(make_tree({}, {}).nodes.empty());
    const Emitter nothing {};
    const uint32_t first = 0;
    const LightTrees trees = make_tree(std::span(&first, 1), std::span(&nothing, 1));
    ASSERT_EQ(trees.nodes.size(), 1u);
    EXPECT_TRUE(std::isfinite(trees.nodes[0].radius) && std::isfinite(trees.nodes[0].cone_cosine));
}

TEST(LightTrees, LeavesAreSmall)
{
    // Nodes are as small as what they hold is near to each other: on average over the leaves a tenth of the hall.
    const LampHall hall(3000);
    const LightTrees trees = make_trees(hall);
    const shared::LightList& list = hall.lists.lists()[0];
    double sum = 0, leaves = 0;
    for (const Part& part : walk(trees, trees.roots[0], list.static_count))
        if (trees.nodes[part.node].second == 0) {
            sum += trees.nodes[part.node].radius;
            leaves++;
        }
    EXPECT_LT(sum / leaves, 0.1 * cell_size * LampHall::size);
}

// What the descent is for: a list of thousands, of which a subset sees eight.
TEST(LightTrees, ErrorIsLowerThanOfSubsetsWhereListsAreLong)
{
    LampHall hall(3000);
    const SamplerTables tables = make_sampler_tables(
        { hall.lists.lists(), hall.lists.static_indices(), hall.lamps }, shared::SAMPLER_NEEDS_TREES);
    const Sampler &subset = find_sampler("subset_dynamic"), &tree = find_sampler("light_tree");
    constexpr int points = 30, draws = 200;
    double subset_error = 0, tree_error = 0;
    for (int point = 0; point < points; point++) {
        ListCase scene;
        scene.point.position = hall.point_on_floor();
        const int cluster = hall.cluster_at(scene.point.position);
        ASSERT_GE(cluster, 0);
        scene.emitters = hall.lamps;
        scene.static_indices = tables.indices;
        scene.range = hall.lists.lists()[size_t(cluster)];
        scene.tables = tables;
        scene.tables.tree_roots.assign(1, tables.tree_roots[size_t(cluster)]); // the list's own
        const double truth = tree.integrate(scene, 2);
        for (int i = 0; i < draws; i++) {
            const Draw draw = make_draw(hall.rng);
            subset_error += std::pow(subset.sample_lights(scene, draw, {}) / truth - 1, 2);
            tree_error += std::pow(tree.sample_lights(scene, draw, {}) / truth - 1, 2);
        }
    }
    EXPECT_LT(tree_error, 0.2 * subset_error);
    RecordProperty("ratio", std::to_string(tree_error / subset_error));
}

} // namespace
} // namespace vkpt::test
