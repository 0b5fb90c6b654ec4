// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/bench/statistics.hpp"

#include <gtest/gtest.h>
#include <random>

namespace vkpt::tests {
namespace {

using namespace vkpt::client;

// Frames whose cost differs tenfold, each measured twice with noise of 10 %.
std::vector<float> measure_frames(size_t count, float factor, unsigned seed)
{
    std::minstd_rand cost(1), random(seed);
    std::uniform_real_distribution<float> costs(1, 10), noise(0.9f, 1.1f);
    std::vector<float> ms;
    for (size_t i = 0; i < count; i++)
        ms.push_back(costs(cost) * factor * noise(random));
    return ms;
}

TEST(BenchStatistics, IntervalHoldsTheTruthAboutAsOftenAsItSays)
{
    int held = 0;
    constexpr int rounds = 100;
    for (unsigned round = 0; round < rounds; round++) {
        const Ratio ratio
            = find_ratio(measure_frames(120, 1, 2 * round + 10), measure_frames(120, 1.05f, 2 * round + 11), 4);
        EXPECT_LE(ratio.low, ratio.value);
        EXPECT_GE(ratio.high, ratio.value);
        EXPECT_LT(ratio.high - ratio.low, 0.08) << "pairs of like frames make it narrow";
        held += ratio.low <= 1.05 && 1.05 <= ratio.high;
    }
    EXPECT_GE(held, 85);
}

TEST(BenchStatistics, RunsOfDifferentLengthAreComparedByTheirMedians)
{
    const Ratio ratio = find_ratio(measure_frames(400, 1, 5), measure_frames(300, 2, 6), 4);
    EXPECT_NEAR(ratio.value, 2, 0.4);
    EXPECT_LT(ratio.low, 2);
    EXPECT_GT(ratio.high, 2);
}

} // namespace
} // namespace vkpt::tests
