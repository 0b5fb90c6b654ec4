// SPDX-License-Identifier: GPL-2.0-or-later
// The traversal on the real driver, with validation, against double precision on the CPU.
#include "shaders/shared/trace.h"
#include "tests/rays/expect_hits.hpp"
#include "tests/rays/reference_tracer.hpp"
#include "tests/rays/scenes.hpp"
#include "tests/rays/trace_on_device.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <memory>

namespace vkpt::tests {
namespace {

using namespace shared;

using TraceSoftware = TraceOnDevice;

// Clutter of all sizes in a room with axis-parallel walls.
std::vector<BvhTriangle> synthetic_scene()
{
    Random random(11);
    std::vector<BvhTriangle> triangles = room(2048.0f, 8);
    for (auto [count, size] : { std::pair(40, 3000.0f), std::pair(2000, 200.0f), std::pair(6000, 20.0f) }) {
        auto more = random_triangles(random, size_t(count), size, uint32_t(triangles.size()));
        triangles.insert(triangles.end(), more.begin(), more.end());
    }
    return triangles;
}

std::vector<Bvh> one_tree(std::span<const BvhTriangle> triangles, BvhQuality quality = BvhQuality::best)
{
    std::vector<Bvh> trees;
    trees.push_back(build_bvh(triangles, quality));
    return trees;
}

TEST(ReferenceTracer, agrees_with_trying_every_triangle)
{
    std::vector<BvhTriangle> triangles = synthetic_scene();
    ReferenceTracer reference(triangles);
    Random random(5);
    for (const TestRay& ray : random_rays(random, 2000, 2000.0f))
        EXPECT_EQ(reference.trace(ray, all_rays).triangle, reference.trace_slowly(ray, all_rays).triangle);
}

TEST_F(TraceSoftware, finds_the_nearest_triangle)
{
    std::vector<BvhTriangle> triangles = synthetic_scene();
    Random random(21);
    std::vector<TestRay> rays = random_rays(random, 1'000'000, 2040.0f);
    expect_nearest_hits(triangles, rays, trace(one_tree(triangles), rays, false, all_rays), all_rays);
}

TEST_F(TraceSoftware, finds_the_nearest_triangle_in_a_quickly_built_tree)
{
    std::vector<BvhTriangle> triangles = synthetic_scene();
    Random random(22);
    std::vector<TestRay> rays = random_rays(random, 200'000, 2040.0f);
    expect_nearest_hits(triangles, rays, trace(one_tree(triangles, BvhQuality::fast), rays, false, all_rays), all_rays);
}

TEST_F(TraceSoftware, tells_visibility)
{
    std::vector<BvhTriangle> triangles = synthetic_scene();
    Random random(23);
    std::vector<TestRay> rays = random_rays(random, 500'000, 2040.0f);
    expect_visibility(triangles, rays, trace(one_tree(triangles), rays, true, all_rays), all_rays);
}

TEST_F(TraceSoftware, meets_only_what_the_mask_allows)
{
    std::vector<BvhTriangle> triangles = synthetic_scene();
    Random random(24);
    for (BvhTriangle& triangle : triangles)
        triangle.mask = uint32_t(random() & 0xff);
    for (uint32_t ray_mask : { 0x01u, 0x80u, 0x24u }) {
        std::vector<TestRay> rays = random_rays(random, 100'000, 2040.0f);
        std::vector<TestHit> hits = trace(one_tree(triangles), rays, false, ray_mask);
        expect_nearest_hits(triangles, rays, hits, ray_mask);
        EXPECT_TRUE(std::all_of(hits.begin(), hits.end(), [&](const TestHit& hit) {
            return hit.triangle == TRACE_MISS || (triangles[hit.triangle].mask & ray_mask) != 0;
        }));
        expect_visibility(triangles, rays, trace(one_tree(triangles), rays, true, ray_mask), ray_mask);
    }
    std::vector<TestRay> rays = random_rays(random, 1000, 2040.0f);
    for (const TestHit& hit : trace(one_tree(triangles), rays, false, 0))
        EXPECT_EQ(hit.triangle, TRACE_MISS);
}

TEST_F(TraceSoftware, searches_two_trees_as_one)
{
    std::vector<BvhTriangle> triangles = synthetic_scene();
    std::vector<BvhTriangle> parts[2];
    for (size_t i = 0; i < triangles.size(); i++)
        parts[i % 7 == 0].push_back(triangles[i]);
    Random random(25);
    std::vector<TestRay> rays = random_rays(random, 200'000, 2040.0f);
    const auto expect_sound = [&](std::span<const BvhTriangle> first, std::span<const BvhTriangle> second) {
        std::vector<Bvh> trees;
        trees.push_back(build_bvh(first, BvhQuality::best));
        trees.push_back(build_bvh(second, BvhQuality::fast));
        expect_nearest_hits(triangles, rays, trace(trees, rays, false, all_rays), all_rays);
        expect_visibility(triangles, rays, trace(trees, rays, true, all_rays), all_rays);
    };
    expect_sound(parts[0], parts[1]);
    expect_sound(parts[1], parts[0]);
    expect_sound(triangles, {});
    expect_sound({}, triangles);
}

TEST_F(TraceSoftware, misses_in_empty_trees)
{
    Random random(26);
    std::vector<TestRay> rays = random_rays(random, 10'000, 1e6f);
    for (const std::vector<Bvh>& trees : { one_tree({}), std::vector<Bvh>(2, build_bvh({}, BvhQuality::fast)) })
        for (bool any_hit : { false, true }) {
            std::vector<TestHit> hits = trace(trees, rays, any_hit, all_rays);
            for (size_t i = 0; i < rays.size(); i++) {
                ASSERT_EQ(hits[i].triangle, TRACE_MISS);
                ASSERT_EQ(hits[i].t, rays[i].t_max);
            }
        }
}

// Along the edges and at the corners of a closed room, where a ray must not slip out between two triangles.
TEST_F(TraceSoftware, does_not_leak_through_shared_edges)
{
    constexpr int cells = 16;
    std::vector<BvhTriangle> walls = room(1024.0f, cells);
    Random random(27);
    std::vector<TestRay> rays;
    for (int i = 0; i < 500'000; i++) {
        const BvhTriangle& triangle = walls[random() % walls.size()];
        uint32_t corner = uint32_t(random() % 3);
        glm::vec3 from(uniform(random, -900, 900), uniform(random, -900, 900), uniform(random, -900, 900));
        if (i % 4 == 0) // so that much cancels exactly
            from = glm::round(from / 64.0f) * 64.0f;
        float along = i % 3 == 0 ? 0.0f : uniform(random, 0, 1);
        glm::vec3 target = glm::mix(triangle.positions[corner], triangle.positions[(corner + 1) % 3], along);
        rays.push_back({ from, 0.0f, i % 2 ? target - from : glm::normalize(target - from), 1e30f });
    }
    for (bool any_hit : { false, true }) {
        std::vector<TestHit> hits = trace(one_tree(walls), rays, any_hit, all_rays);
        size_t leaks = size_t(
            std::count_if(hits.begin(), hits.end(), [](const TestHit& hit) { return hit.triangle == TRACE_MISS; }));
        EXPECT_EQ(leaks, 0u) << "of " << rays.size();
        for (const TestHit& hit : hits)
            ASSERT_TRUE(hit.barycentrics.x >= 0.0f && hit.barycentrics.y >= 0.0f
                && hit.barycentrics.x + hit.barycentrics.y <= 1.00001f);
    }
}

TEST_F(TraceSoftware, keeps_to_the_open_interval_of_distances)
{
    BvhTriangle wall { { { 8, -100, -100 }, { 8, 100, -100 }, { 8, 0, 100 } }, 0, 1 };
    glm::vec3 ahead(1, 0, 0);
    std::vector<TestRay> rays {
        { glm::vec3(0), 0.0f, ahead, 8.0f }, // ends on it
        { glm::vec3(0), 0.0f, ahead, 8.001f }, // just beyond
        { glm::vec3(0), 8.0f, ahead, 100.0f }, // begins on it
        { glm::vec3(0), 7.999f, ahead, 100.0f }, // just before
        { glm::vec3(8, 0, 0), 0.0f, ahead, 100.0f }, // starts in it
        { glm::vec3(0), 0.0f, -ahead, 100.0f }, // away from it
        { glm::vec3(0), 0.0f, ahead * 2.0f, 4.001f }, // distances are in lengths of the direction
        { glm::vec3(0), 0.0f, ahead, -5.0f }, // nothing to search
        { glm::vec3(16, 0, 0), 0.0f, -ahead, std::numeric_limits<float>::infinity() }, // from the other side
    };
    bool meets[] = { false, true, false, true, false, false, true, false, true };
    for (bool any_hit : { false, true }) {
        std::vector<TestHit> hits = trace(one_tree(std::span(&wall, 1)), rays, any_hit, all_rays);
        for (size_t i = 0; i < rays.size(); i++)
            EXPECT_EQ(hits[i].triangle == 0, meets[i]) << "ray " << i;
        EXPECT_EQ(hits[1].front, 0u);
        EXPECT_EQ(hits[8].front, 1u);
        EXPECT_FLOAT_EQ(hits[6].t, 4.0f);
    }
}

// No ray may hang, crash or report what is not there.
TEST_F(TraceSoftware, survives_senseless_rays)
{
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const float values[] = { 0.0f, -0.0f, 1.0f, -1.0f, 1e-40f, -1e-30f, 1e30f, -3e38f, nan, -nan, infinity, -infinity };
    std::vector<BvhTriangle> triangles = synthetic_scene();
    Random random(28);
    auto any_value = [&] { return values[random() % std::size(values)]; };
    std::vector<TestRay> rays;
    for (int i = 0; i < 8'000; i++) {
        TestRay ray { glm::vec3(uniform(random, -2000, 2000)), 0.0f, random_direction(random), 1e4f };
        float* fields[] = { &ray.origin.x, &ray.origin.y, &ray.origin.z, &ray.t_min, &ray.direction.x, &ray.direction.y,
            &ray.direction.z, &ray.t_max };
        for (int changes = 1 + i % 8; changes > 0; changes--)
            *fields[random() % std::size(fields)] = any_value();
        rays.push_back(ray);
    }
    rays.push_back({ glm::vec3(0), 0.0f, glm::vec3(0), infinity });
    rays.push_back({ glm::vec3(nan), 0.0f, glm::vec3(nan), nan });
    for (BvhQuality quality : { BvhQuality::best, BvhQuality::fast })
        for (bool any_hit : { false, true }) {
            std::vector<TestHit> hits = trace(one_tree(triangles, quality), rays, any_hit, all_rays);
            for (const TestHit& hit : hits)
                ASSERT_TRUE(hit.triangle == TRACE_MISS || (hit.triangle < triangles.size() && hit.t >= 0.0f));
            EXPECT_EQ(hits[rays.size() - 2].triangle, TRACE_MISS) << "no direction";
            EXPECT_EQ(hits[rays.size() - 1].triangle, TRACE_MISS) << "NaN";
        }
}

// What needs the deepest stacks: neighbours in memory must not be overwritten.
TEST_F(TraceSoftware, walks_heaps_of_overlapping_triangles)
{
    std::vector<BvhTriangle> triangles;
    Random random(29);
    for (uint32_t i = 0; i < 8'000; i++) {
        float size = std::pow(1.004f, float(i % 4000)) * 1e-3f;
        glm::vec3 shift(0, 0, uniform(random, -0.5f, 0.5f) * size);
        triangles.push_back({ { glm::vec3(-size, -size, 0) + shift, glm::vec3(size, -size, 0) + shift,
                                  glm::vec3(0, size, size) + shift },
            i, 0xff });
    }
    std::vector<TestRay> rays = random_rays(random, 5'000, 1000.0f);
    expect_nearest_hits(triangles, rays, trace(one_tree(triangles), rays, false, all_rays), all_rays);
}

TEST_F(TraceSoftware, finds_the_nearest_triangle_in_maps)
{
    const char* folder = std::getenv("VKPT_TEST_MAPS");
    if (!folder)
        GTEST_SKIP() << "VKPT_TEST_MAPS names no folder of maps";
    size_t maps = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".bsp")
            continue;
        SCOPED_TRACE(entry.path().filename().string());
        maps++;
        std::vector<BvhTriangle> triangles = load_map(entry.path()).triangles;
        float half = 0.0f;
        for (const BvhTriangle& triangle : triangles)
            for (glm::vec3 p : triangle.positions)
                half = std::max({ half, std::abs(p.x), std::abs(p.y), std::abs(p.z) });
        Random random(30);
        std::vector<TestRay> rays = random_rays(random, 1'000'000, half);
        expect_nearest_hits(triangles, rays, trace(one_tree(triangles), rays, false, all_rays), all_rays);
        rays.resize(200'000);
        expect_visibility(triangles, rays, trace(one_tree(triangles), rays, true, all_rays), all_rays);
    }
    EXPECT_GT(maps, 0u) << "no .bsp in " << folder;
}

} // namespace
} // namespace vkpt::tests
