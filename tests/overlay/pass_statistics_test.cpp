// SPDX-License-Identifier: GPL-2.0-or-later
// Times that are collected for as long as a game runs.
#include "ref_vkpt/pass_statistics.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

TEST(PassStatistics, KeepTheNewestTimes)
{
    PassStatistics statistics;
    constexpr size_t added = 10 * PassStatistics::kept + 3;
    for (size_t i = 0; i < added; i++)
        statistics.add("a", double(i));
    statistics.add("b", 1);
    ASSERT_EQ(statistics.passes().size(), 2u);
    const std::vector<float>& kept = statistics.passes()[0].milliseconds;
    EXPECT_GE(kept.size(), PassStatistics::kept);
    EXPECT_LE(kept.size(), 2 * PassStatistics::kept);
    for (size_t i = 0; i < kept.size(); i++)
        ASSERT_EQ(kept[i], float(added - kept.size() + i)) << "the newest, oldest first";
}

} // namespace
} // namespace vkpt::tests
