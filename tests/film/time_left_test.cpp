// SPDX-License-Identifier: GPL-2.0-or-later
// What a film says of the time that it will still take.
#include "client/film/time_left.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

using client::TimeLeft;
using std::chrono::seconds;

TEST(TimeLeft, IsSaidOnceAMinute)
{
    const TimeLeft::Clock::time_point start {};
    TimeLeft left(100, start);
    EXPECT_EQ(left.describe(1, start + seconds(59)), "");
    EXPECT_EQ(left.describe(10, start + seconds(60)), "frame 10 of 100, 9 minutes left");
    EXPECT_EQ(left.describe(11, start + seconds(119)), "");
    EXPECT_EQ(left.describe(40, start + seconds(120)), "frame 40 of 100, 3 minutes left");
    EXPECT_EQ(left.describe(99, start + seconds(240)), "frame 99 of 100, 1 minutes left");
    EXPECT_EQ(left.describe(100, start + seconds(600)), "") << "it is done";
}

} // namespace
} // namespace vkpt::tests
