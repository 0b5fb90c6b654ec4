// SPDX-License-Identifier: GPL-2.0-or-later
// What goes to the device's own ray tracing (shaders/lib/ray.glsl, as C++), and which backend counts as the fastest.
#include "ref_vkpt/rays/trace_ranking.hpp"
#include "shaders/shared/trace.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/glm.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace vkpt::test {
namespace {

namespace glsl {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
using namespace vkpt::shared;
using namespace ::glm;
#include "shaders/lib/ray.glsl"
#pragma GCC diagnostic pop
} // namespace glsl
using glsl::Ray;

// Valid usage of rayQueryInitializeEXT and traceRayEXT: finite, 0 <= t_min <= t_max.
bool is_legal(const Ray& ray)
{
    bool finite = true;
    for (int i = 0; i < 3; i++)
        finite &= std::isfinite(ray.origin[i]) && std::isfinite(ray.direction[i]);
    return finite && glm::length(ray.direction) > 0.5f && ray.t_min >= 0 && ray.t_max >= ray.t_min;
}

TEST(LegalRays, StayAsTheyAre)
{
    for (const Ray& ray : { Ray { { 1, 2, 3 }, { 0, 0.6f, 0.8f }, 0, 100 },
             Ray { { -4096, 4096, 0 }, { 1, 0, 0 }, 0.01f, 1e30f }, Ray { { 0, 0, 0 }, { 0, 0, -1 }, 2, 2 } }) {
        const Ray legal = glsl::legal_ray(ray);
        EXPECT_EQ(legal.origin, ray.origin);
        EXPECT_EQ(legal.direction, ray.direction);
        EXPECT_EQ(legal.t_min, ray.t_min);
        EXPECT_EQ(legal.t_max, ray.t_max);
    }
}

TEST(LegalRays, AreMadeOfWhatIsNone)
{
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const glm::vec3 here(1, 2, 3), up(0, 0, 1);
    // Between two places a hundredth of a unit apart, of which a margin is taken off at both ends; between two that are
    // one, whose direction is 0 / 0.
    for (const Ray& ray : { Ray { here, up, 0.01f, 0.005f }, Ray { here, up, 0.01f, -0.01f },
             Ray { here, glm::vec3(nan), 0.01f, 100 }, Ray { here, { 0, nan, 1 }, 0, 1 }, Ray { here, up, 0, nan },
             Ray { here, up, nan, 1 }, Ray { glm::vec3(inf), up, 0, 1 }, Ray { here, { inf, 0, 0 }, 0, 1 },
             Ray { glm::vec3(nan), glm::vec3(nan), nan, nan } }) {
        EXPECT_FALSE(is_legal(ray)) << "the test's own ray";
        const Ray legal = glsl::legal_ray(ray);
        EXPECT_TRUE(is_legal(legal));
        EXPECT_EQ(legal.t_max, legal.t_min) << "it might meet something";
    }
}

using Times = std::vector<std::vector<double>>;

TEST(TraceRanking, GoesByMedians)
{
    const auto ranking = rank_traces(Times { { 5, 5.1, 4.9, 5, 5 }, { 2, 2.1, 2, 90, 1.9 }, { 3, 3, 3, 3, 0.1 } });
    ASSERT_TRUE(ranking);
    EXPECT_EQ(ranking->fastest, 1u) << "one hiccup and one lucky turn";
    EXPECT_TRUE(ranking->is_clear);
    EXPECT_EQ(ranking->medians, (std::vector<double> { 5, 2, 3 }));
}

TEST(TraceRanking, TellsTiesFromResults)
{
    EXPECT_FALSE(rank_traces(Times { { 2, 2, 2 }, { 2.02, 2.02, 2.02 } })->is_clear) << "a per cent";
    EXPECT_FALSE(rank_traces(Times { { 1, 2, 9, 2, 1 }, { 1, 3, 8, 3, 1 } })->is_clear) << "they spread widely";
    EXPECT_TRUE(rank_traces(Times { { 2 }, { 3 } })->is_clear);
    EXPECT_TRUE(rank_traces(Times { { 2, 2, 2 } })->is_clear);
    EXPECT_FALSE(rank_traces(Times { { 0, 0, 0 }, { 0, 0, 1 } })) << "a device that does nothing";
    EXPECT_FALSE(rank_traces(Times {}));
}

} // namespace
} // namespace vkpt::test
