// SPDX-License-Identifier: GPL-2.0-or-later
// Two levels of trees for what moves: sound in every pose, and on the real driver rays find in them what they find
// without a tree.
#include "ref_vkpt/scene/moving_geometry.hpp"
#include "tests/rays/expect_hits.hpp"
#include "tests/rays/scenes.hpp"
#include "tests/rays/trace_on_device.hpp"
#include "tests/rays/tree_check.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace vkpt::tests {
namespace {

using namespace shared;

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

struct Written {
    std::vector<Triangle> triangles;
    std::vector<uint32_t> masks;
    Bvh bvh;
};

Written write(const MovingGeometry& geometry, unsigned threads = 2, const TreePlace& place = {})
{
    Workers workers(threads);
    Written out;
    out.triangles.resize(geometry.triangle_count());
    out.masks.resize(geometry.triangle_count());
    out.bvh.nodes.resize(geometry.node_count() * bvh_node_words, 0xdeadbeef);
    out.bvh.triangles.resize(std::max<size_t>(geometry.triangle_count(), 1) * bvh_triangle_words);
    MovingWriter(workers).write(geometry,
        { out.triangles.data(), out.masks.data(), out.bvh.nodes.data(), out.bvh.triangles.data(), nullptr, place });
    out.bvh.node_count = uint32_t(geometry.node_count());
    out.bvh.triangle_count = uint32_t(geometry.triangle_count());
    out.bvh.max_depth = 100;
    return out;
}

// Every triangle is in one leaf, with its id, and nothing reaches out of its box; returns the stack that it needs.
uint32_t expect_sound(const Written& written, uint32_t first_id = 0)
{
    TreeCheck check(written.bvh);
    const uint32_t need = check.check(0, 1).second;
    EXPECT_LE(need, TRACE_STACK_ENTRIES);
    EXPECT_TRUE(std::ranges::all_of(check.node_visits, [](uint32_t n) { return n <= 1; }));
    EXPECT_TRUE(std::ranges::all_of(check.triangle_visits, [](uint32_t n) { return n == 1; }));
    std::vector<bool> seen(written.triangles.size());
    for (uint32_t slot = 0; slot < written.bvh.triangle_count; slot++) {
        const DecodedTriangle record = decode_triangle(written.bvh, slot);
        const uint32_t i = (record.id_and_mask & BVH_ID_MASK) - first_id;
        if (i >= seen.size() || seen[i]) {
            ADD_FAILURE() << "id " << i << " at " << slot;
            break;
        }
        seen[i] = true;
        EXPECT_TRUE(std::ranges::equal(record.corners, written.triangles[i].positions)) << i;
        EXPECT_EQ(record.id_and_mask >> BVH_RAY_MASK_SHIFT, written.masks[i]) << i;
    }
    return need;
}

formats::Md2Model load_player()
{
    std::ifstream file(VKPT_GAME_DATA "/players/male/tris.md2", std::ios::binary);
    std::vector<char> content { std::istreambuf_iterator<char>(file), {} };
    return formats::read_md2(std::as_bytes(std::span(content)), "players/male/tris.md2");
}

// One frame of loose triangles.
formats::Md2Model make_model(std::span<const BvhTriangle> triangles)
{
    formats::Md2Model model;
    formats::Md2Model::Frame& frame = model.frames.emplace_back();
    for (const BvhTriangle& triangle : triangles)
        for (const glm::vec3 p : triangle.positions) {
            model.indices.push_back(uint32_t(model.texture_coordinates.size()));
            model.texture_coordinates.emplace_back(0);
            frame.positions.push_back(p);
            frame.normals.emplace_back(0, 0, 1);
        }
    return model;
}

std::vector<Triangle> as_map_triangles(std::span<const BvhTriangle> sources)
{
    std::vector<Triangle> triangles(sources.size());
    for (size_t i = 0; i < sources.size(); i++)
        std::ranges::copy(sources[i].positions, triangles[i].positions);
    return triangles;
}

Md2Pose random_pose(Random& random, float half)
{
    Md2Pose pose;
    const auto coordinate = [&] { return uniform(random, -half, half); };
    pose.transform = md2_transform({ coordinate(), coordinate(), coordinate() },
        { uniform(random, -90, 90), uniform(random, 0, 360), uniform(random, -20, 20) });
    pose.frame = int(random() % 250);
    pose.old_frame = int(random() % 250);
    pose.backlerp = uniform(random, -0.2f, 1);
    if (random() % 4 == 0)
        pose.shell_distance = powerup_shell_distance;
    if (random() % 4 == 0)
        pose.mirror = Mirror { { coordinate(), 0, 0 }, random_direction(random) };
    if (random() % 4 == 0)
        pose.squeeze = Squeeze { { 0, coordinate(), 0 }, random_direction(random), uniform(random, 0.2f, 1),
            uniform(random, 0.3f, 2) };
    return pose;
}

void add_particles(MovingGeometry& geometry, Random& random, int count, float half)
{
    for (int i = 0; i < count; i++)
        append_particle({ uniform(random, -half, half), uniform(random, -half, half), uniform(random, -half, half) },
            glm::vec3(0), angle_vectors({ 10, 20, 0 }), 1, geometry.loose());
    geometry.mask_loose(MASK_TRANSLUCENT);
}

std::vector<BvhTriangle> as_trace_triangles(const Written& written)
{
    std::vector<BvhTriangle> triangles(written.triangles.size());
    for (uint32_t i = 0; i < triangles.size(); i++) {
        std::ranges::copy(written.triangles[i].positions, triangles[i].positions);
        triangles[i].id = i;
        triangles[i].mask = written.masks[i];
    }
    return triangles;
}

// A crowd of players in all poses, a few doors, particles.
struct Crowd {
    static constexpr float half = 150;
    std::shared_ptr<const Md2Mesh> player = std::make_shared<Md2Mesh>(load_player());
    std::vector<Triangle> door_triangles;
    std::vector<uint32_t> door_masks;
    BrushMesh door;
    std::vector<uint32_t> materials { 5 };

    Crowd()
    {
        for (const BvhTriangle& wall : room(30, 3)) {
            Triangle& triangle = door_triangles.emplace_back();
            std::ranges::copy(wall.positions, triangle.positions);
            door_masks.push_back(door_masks.size() % 3 ? MASK_OPAQUE : MASK_ALPHA_TEST);
        }
        door = make_brush_mesh(door_triangles, door_masks);
    }

    MovingGeometry list(uint32_t seed, int players) const
    {
        Random random(seed);
        MovingGeometry geometry;
        for (int i = 0; i < players; i++)
            EXPECT_TRUE(geometry.add(player, random_pose(random, half), 3, i % 2 ? MASK_OPAQUE : MASK_OWN_BODY));
        for (int i = 0; i < 3; i++) {
            BrushPose pose;
            pose.transform = random_pose(random, half).transform;
            pose.materials = materials;
            pose.mask = i == 0 ? MASK_TRANSLUCENT : 0;
            EXPECT_TRUE(geometry.add(door, pose));
        }
        add_particles(geometry, random, 300, half);
        return geometry;
    }
};

TEST(MovingGeometry, is_sound_in_every_pose)
{
    const Crowd crowd;
    EXPECT_GT(crowd.player->triangle_count(), 500u);
    for (uint32_t seed = 1; seed < 9; seed++) {
        const Written written = write(crowd.list(seed, 20));
        EXPECT_GT(expect_sound(written), 7u);
        ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
    }
}

TEST(MovingGeometry, stands_in_its_bounds)
{
    const Md2Mesh mesh(load_player());
    Random random(3);
    std::vector<Float4> points;
    for (int i = 0; i < 300; i++) {
        const Md2Pose pose = random_pose(random, i % 2 ? 100 : 5e5f);
        const Box bounds = mesh.bounds(pose);
        mesh.pose(pose, points);
        for (const uint32_t corner : mesh.corners())
            for (int axis = 0; axis < 3; axis++) {
                ASSERT_LE(bounds.low[axis], points[corner][axis]) << i;
                ASSERT_GE(bounds.high[axis], points[corner][axis]) << i;
            }
    }
}

TEST(MovingGeometry, is_the_same_whatever_the_number_of_threads)
{
    const Crowd crowd;
    const MovingGeometry geometry = crowd.list(4, 30);
    const Written one = write(geometry, 1), five = write(geometry, 5);
    EXPECT_EQ(one.bvh.nodes, five.bvh.nodes);
    EXPECT_EQ(one.bvh.triangles, five.bvh.triangles);
    EXPECT_EQ(one.masks, five.masks);
}

// The map's tree stands before that of what moves.
void expect_counts_from_place(const MovingGeometry& geometry)
{
    constexpr TreePlace place { 1000, 70'000 };
    const Written at_place = write(geometry, 2, place);
    Written at_start = write(geometry);
    place_nodes(at_start.bvh.nodes, place);
    uint32_t compared = 0;
    for (size_t node = 0; node < at_place.bvh.nodes.size(); node += bvh_node_words) {
        const auto one = std::span(at_place.bvh.nodes).subspan(node, bvh_node_words);
        if (one[0] == 0xdeadbeef) // room that was not needed
            continue;
        compared++;
        EXPECT_TRUE(std::ranges::equal(one, std::span(at_start.bvh.nodes).subspan(node, bvh_node_words)));
    }
    EXPECT_GT(compared, 10u);
    EXPECT_EQ(at_place.bvh.triangles, at_start.bvh.triangles);
}

TEST(MovingGeometry, counts_from_its_place_among_all_trees) { expect_counts_from_place(Crowd().list(5, 12)); }

TEST(MovingGeometry, is_an_empty_tree_of_nothing)
{
    const Written written = write(MovingGeometry());
    EXPECT_EQ(written.bvh.node_count, 1u);
    EXPECT_EQ(expect_sound(written), 0u);
}

TEST(MovingGeometry, leaves_out_what_has_no_place)
{
    const std::vector<BvhTriangle> one { { { { 0, 0, 0 }, { 8, 0, 0 }, { 0, 8, 0 } }, 0, 1 } };
    formats::Md2Model model = make_model(one);
    for (int frame = 1; frame < 5; frame++)
        model.frames.push_back(model.frames[0]);
    model.frames[1].positions[2].y = nan_value;
    model.frames[2].positions[0].x = 1e20f;
    model.frames[3].normals[1].z = std::numeric_limits<float>::infinity();
    const auto mesh = std::make_shared<Md2Mesh>(model);
    MovingGeometry geometry;
    for (const int frame : { 1, 2, 3 }) {
        EXPECT_FALSE(geometry.add(mesh, { .frame = frame }, 0, 1)) << frame;
        EXPECT_FALSE(geometry.add(mesh, { .frame = 0, .old_frame = frame, .backlerp = 0.1f }, 0, 1)) << frame;
        EXPECT_TRUE(geometry.add(mesh, { .frame = 4, .old_frame = frame }, 0, 1)) << frame;
    }
    EXPECT_FALSE(geometry.add(mesh, { .transform = md2_transform({ 0, nan_value, 0 }, {}) }, 0, 1));
    EXPECT_FALSE(geometry.add(mesh, { .squeeze = Squeeze { {}, { 1, 0, 0 }, nan_value, 1 } }, 0, 1));
    EXPECT_FALSE(geometry.add(mesh, { .squeeze = Squeeze { {}, { 1, 0, 0 }, 1, nan_value } }, 0, 1));
    EXPECT_FALSE(geometry.add(std::make_shared<Md2Mesh>(formats::Md2Model()), {}, 0, 1));
    EXPECT_FALSE(geometry.add(make_brush_mesh({}, {}), {}));
    EXPECT_EQ(geometry.triangle_count(), 3u);
    expect_sound(write(geometry));
}

TEST(MovingGeometry, keeps_to_ids_of_24_bits)
{
    const std::vector<BvhTriangle> ten = room(8, 1);
    const auto mesh = std::make_shared<Md2Mesh>(make_model(ten));
    const uint32_t first_id = (1u << 24) - 30;
    MovingGeometry geometry(first_id);
    EXPECT_TRUE(geometry.add(mesh, {}, 0, 1));
    EXPECT_TRUE(geometry.add(mesh, {}, 0, 1));
    EXPECT_FALSE(geometry.add(mesh, {}, 0, 1)); // 6 left of 12
    Random random(6);
    add_particles(geometry, random, 100, 50);
    EXPECT_EQ(geometry.triangle_count(), 30u);
    expect_sound(write(geometry), first_id);
}

// Triangles each twice as far out as the one before, as a mesh of its own or all in one, make the deepest trees.
std::vector<BvhTriangle> exponential_triangles(int copies)
{
    std::vector<BvhTriangle> triangles;
    for (int axis = 0; axis < 3; axis++)
        for (int exponent = -60; exponent < 19; exponent++)
            for (int copy = 0; copy < copies; copy++) {
                glm::vec3 at(0);
                at[axis] = std::ldexp(1.0f, exponent);
                const float size = std::ldexp(1.0f, exponent - 6);
                triangles.push_back({ { at, at + glm::vec3(size, 0, 0), at + glm::vec3(0, size, size) },
                    uint32_t(triangles.size()), 1 });
            }
    return triangles;
}

TEST(MovingGeometry, stays_walkable_with_deep_meshes_under_a_deep_tree)
{
    const std::vector<BvhTriangle> triangles = exponential_triangles(60);
    const auto deep = std::make_shared<Md2Mesh>(make_model(triangles));
    EXPECT_LE(deep->tree().stack_need, mesh_stack_budget);
    MovingGeometry geometry;
    geometry.add(deep, {}, 0, 1);
    for (const BvhTriangle& triangle : exponential_triangles(16)) // 3,792 meshes
        geometry.add(std::make_shared<Md2Mesh>(make_model(std::span(&triangle, 1))), {}, 0, 1);
    EXPECT_GT(expect_sound(write(geometry)), mesh_stack_budget);
}

TEST(MovingGeometry, falls_back_to_one_tree_where_there_is_too_much)
{
    Random random(8);
    const auto small = std::make_shared<Md2Mesh>(make_model(random_triangles(random, 3, 20)));
    MovingGeometry many;
    for (uint32_t i = 0; i < max_moving_meshes + 10; i++) {
        Md2Pose pose;
        pose.transform = md2_transform({ uniform(random, -3000, 3000), 0, uniform(random, -3000, 3000) }, {});
        many.add(small, pose, 0, 1);
    }
    EXPECT_EQ(many.triangle_count(), (max_moving_meshes + 10) * 3);
    expect_counts_from_place(many);
    expect_sound(write(many));

    const std::vector<Triangle> triangles = as_map_triangles(random_triangles(random, max_mesh_triangles + 1, 20));
    const BrushMesh large = make_brush_mesh(triangles, std::vector<uint32_t>(triangles.size(), MASK_OPAQUE));
    const std::vector<uint32_t> materials { 0 };
    MovingGeometry geometry;
    EXPECT_TRUE(geometry.add(large, { .materials = materials }));
    EXPECT_TRUE(geometry.add(small, {}, 0, 1));
    expect_sound(write(geometry));
}

TEST(Refit, is_not_spoilt_by_nan)
{
    Random random(9);
    const std::vector<BvhTriangle> triangles = random_triangles(random, 100, 50);
    std::vector<Box> boxes(triangles.size());
    std::vector<Float4> points;
    for (size_t i = 0; i < triangles.size(); i++)
        for (const glm::vec3 p : triangles[i].positions) {
            boxes[i].add(p);
            points.push_back(to_float4(p));
        }
    const MeshTree tree = build_mesh_tree(boxes);
    std::vector<uint32_t> corners;
    Box expected;
    for (const uint32_t triangle : tree.order)
        for (uint32_t corner = 0; corner < 3; corner++)
            corners.push_back(triangle * 3 + corner);
    for (size_t i = 0; i < points.size(); i++)
        if (i % 7 == 0)
            points[i] = splat(nan_value);
        else
            expected.add(to_vec3(points[i]));
    std::vector<uint32_t> nodes(tree.node_count * bvh_node_words);
    std::vector<Box4> scratch;
    const Box box = refit(tree, corners, points.data(), box_margin(expected), {}, nodes.data(), scratch);
    EXPECT_EQ(box.low, expected.low);
    EXPECT_EQ(box.high, expected.high);
}

using TraceMoving = TraceOnDevice;

TEST_F(TraceMoving, finds_what_a_search_without_trees_finds)
{
    const Crowd crowd;
    for (const uint32_t seed : { 11u, 12u }) {
        Written written = write(crowd.list(seed, 25));
        const std::vector<BvhTriangle> triangles = as_trace_triangles(written);
        Random random(seed);
        const std::vector<TestRay> rays = random_rays(random, 200'000, Crowd::half * 1.3f);
        for (const uint32_t ray_mask : { all_rays, MASK_OPAQUE | MASK_TRANSLUCENT }) {
            expect_nearest_hits(triangles, rays, trace(std::span(&written.bvh, 1), rays, false, ray_mask), ray_mask);
            expect_visibility(triangles, rays, trace(std::span(&written.bvh, 1), rays, true, ray_mask), ray_mask);
        }
    }
}

TEST_F(TraceMoving, walks_the_deepest_trees)
{
    const std::vector<BvhTriangle> sources = exponential_triangles(12);
    const auto deep = std::make_shared<Md2Mesh>(make_model(sources));
    MovingGeometry geometry;
    for (int i = 0; i < 3; i++)
        geometry.add(deep, { .transform = md2_transform({ 0, 0, float(i) }, { 0, float(i) * 20, 0 }) }, 0, 1);
    Written written = write(geometry);
    const std::vector<BvhTriangle> triangles = as_trace_triangles(written);
    std::vector<TestRay> rays;
    Random random(13);
    for (int i = 0; i < 20'000; i++) { // towards triangles that are not too small to be met
        const BvhTriangle& target = triangles[random() % triangles.size()];
        const glm::vec3 middle = (target.positions[0] + target.positions[1] + target.positions[2]) / 3.0f;
        if (std::abs(middle.x) + std::abs(middle.y) + std::abs(middle.z) < 8)
            continue;
        const glm::vec3 from(uniform(random, 1, 300), uniform(random, 1, 300), uniform(random, 1, 300));
        rays.push_back({ from, 0, glm::normalize(middle - from), 1e30f });
    }
    expect_nearest_hits(triangles, rays, trace(std::span(&written.bvh, 1), rays, false, all_rays), all_rays);
}

TEST(Workers, do_every_item_once)
{
    Workers workers(4);
    EXPECT_EQ(workers.thread_count(), 4u);
    for (size_t count : { 0u, 1u, 3u, 1000u })
        for (int round = 0; round < 20; round++) {
            std::vector<std::atomic<int>> done(count);
            workers.parallel_for(count, [&](size_t item, size_t thread) {
                EXPECT_LT(thread, 4u);
                done[item]++;
            });
            EXPECT_TRUE(std::ranges::all_of(done, [](const auto& times) { return times == 1; }));
        }
}

TEST(Workers, hand_exceptions_to_the_caller_and_go_on)
{
    Workers workers(3);
    for (int round = 0; round < 20; round++)
        EXPECT_THROW(workers.parallel_for(100,
                         [](size_t item, size_t) {
                             if (item % 10 == 5)
                                 throw std::runtime_error("five");
                         }),
            std::runtime_error);
    std::atomic<int> done = 0;
    workers.parallel_for(100, [&](size_t, size_t) { done++; });
    EXPECT_EQ(done, 100);
}

} // namespace
} // namespace vkpt::tests
