// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/rays/expect_hits.hpp"

#include "shaders/shared/trace.h"
#include "tests/rays/reference_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {

using namespace shared;

namespace {

// How far off a computed distance may be: a few rounding errors of the coordinates, the more the flatter the ray meets
// the plane.
double distance_rounding(const TestRay& ray, const PlaneCrossing& crossing)
{
    double size = std::max({ 1.0, std::abs(crossing.t), double(glm::length(ray.origin)) });
    return 2e-6 * size / std::max(crossing.slope, 1e-6);
}

bool is_at_a_limit(const TestRay& ray, const PlaneCrossing& crossing)
{
    double rounding = distance_rounding(ray, crossing);
    return std::abs(crossing.t - double(ray.t_min)) < rounding || std::abs(crossing.t - double(ray.t_max)) < rounding;
}

// Whether float rounding may decide differently from double: the ray passes within 1e-4 of an edge (in weights), or
// ends there.
bool is_close_call(const TestRay& ray, const PlaneCrossing& crossing)
{
    return std::abs(crossing.edge_distance()) < 1e-4 || is_at_a_limit(ray, crossing);
}

void expect_same_place(const TestRay& ray, const TestHit& hit, const PlaneCrossing& expected, size_t index)
{
    double rounding = distance_rounding(ray, expected);
    EXPECT_NEAR(hit.t, expected.t, rounding) << "ray " << index;
    EXPECT_NEAR(hit.barycentrics.x, expected.u, 1e-5 + rounding / expected.size) << "ray " << index;
    EXPECT_NEAR(hit.barycentrics.y, expected.v, 1e-5 + rounding / expected.size) << "ray " << index;
    EXPECT_EQ(hit.front, uint32_t(expected.front)) << "ray " << index;
}

} // namespace

void expect_nearest_hits(std::span<const BvhTriangle> triangles, std::span<const TestRay> rays,
    std::span<const TestHit> hits, uint32_t ray_mask)
{
    ReferenceTracer reference(triangles);
    size_t same = 0, ties = 0, unexplained = 0, reference_hits = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        ReferenceHit expected = reference.trace(rays[i], ray_mask);
        bool met = hits[i].triangle != TRACE_MISS;
        reference_hits += expected.triangle >= 0;
        ASSERT_TRUE(!met || hits[i].triangle < triangles.size()) << "ray " << i << " reports " << hits[i].triangle;
        if (met ? expected.triangle == int64_t(hits[i].triangle) : expected.triangle < 0) {
            same++;
            if (met)
                expect_same_place(rays[i], hits[i], expected.crossing, i);
            continue;
        }
        PlaneCrossing found = met ? cross_plane(rays[i], triangles[hits[i].triangle]) : PlaneCrossing {};
        if (met && expected.triangle >= 0
            && std::abs(found.t - expected.crossing.t) < 2.0 * distance_rounding(rays[i], expected.crossing)) {
            ties++;
            continue;
        }
        bool close = (met && is_close_call(rays[i], found))
            || (expected.triangle >= 0 && is_close_call(rays[i], expected.crossing));
        if (!close && ++unexplained < 10)
            ADD_FAILURE() << "ray " << i << ": met " << int64_t(met ? hits[i].triangle : -1) << " at " << hits[i].t
                          << " (edge distance " << found.edge_distance() << "), expected " << expected.triangle
                          << " at " << expected.crossing.t << " (edge distance " << expected.crossing.edge_distance()
                          << ")";
    }
    EXPECT_EQ(unexplained, 0u);
    EXPECT_GE(double(same + ties), 0.9999 * double(rays.size()));
    EXPECT_GT(reference_hits, rays.size() / 20) << "too few rays meet anything for this test to mean much";
    std::printf("    %zu of %zu rays agree, %zu meet something, %zu ties\n", same, rays.size(), reference_hits, ties);
}

void expect_visibility(std::span<const BvhTriangle> triangles, std::span<const TestRay> rays,
    std::span<const TestHit> hits, uint32_t ray_mask)
{
    ReferenceTracer reference(triangles);
    size_t same = 0, unexplained = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        ReferenceHit expected = reference.trace(rays[i], ray_mask);
        bool met = hits[i].triangle != TRACE_MISS;
        ASSERT_TRUE(!met || hits[i].triangle < triangles.size());
        if (met == (expected.triangle >= 0)) {
            same++;
            continue;
        }
        bool close
            = is_close_call(rays[i], met ? cross_plane(rays[i], triangles[hits[i].triangle]) : expected.crossing);
        unexplained += !close;
    }
    EXPECT_EQ(unexplained, 0u);
    EXPECT_GE(double(same), 0.9999 * double(rays.size()));
}

} // namespace vkpt::tests
