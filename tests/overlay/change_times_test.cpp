// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/overlay/change_times.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr size_t under_way = 2;

void note_frames(ChangeTimes& times, int frames, double milliseconds)
{
    for (int i = 0; i < frames; i++)
        times.note_frame(milliseconds);
}

void expect_times(const ChangeTimes& times, size_t row, double before, double after)
{
    const auto found = times.find(row);
    ASSERT_TRUE(found) << row;
    EXPECT_EQ(found->before, before) << row;
    EXPECT_EQ(found->after, after) << row;
}

TEST(ChangeTimes, AreMediansOfTheFramesBeforeAndAfter)
{
    ChangeTimes times(under_way);
    EXPECT_EQ(times.newest(), 0);
    note_frames(times, 100, 50);
    note_frames(times, 8, 20); // more than half of those that count
    note_frames(times, 1, 90);
    EXPECT_EQ(times.newest(), 20);
    EXPECT_FALSE(times.find(3));
    times.note_change(3);
    note_frames(times, under_way, 20);
    expect_times(times, 3, 20, 0); // its frames are under way
    note_frames(times, 1, 12);
    expect_times(times, 3, 20, 12);
    note_frames(times, 1, 1000);
    note_frames(times, 5, 14);
    expect_times(times, 3, 20, 14);
    note_frames(times, 20, 10);
    expect_times(times, 3, 20, 10);
}

TEST(ChangeTimes, StandForEachRowUntilTheyAreForgotten)
{
    ChangeTimes times(under_way);
    note_frames(times, 20, 30);
    times.note_change(1);
    note_frames(times, 20, 20);
    times.note_change(5);
    note_frames(times, 20, 40);
    expect_times(times, 1, 30, 20);
    expect_times(times, 5, 20, 40);
    times.note_change(1); // again, later
    note_frames(times, 20, 35);
    expect_times(times, 1, 40, 35);
    expect_times(times, 5, 20, 40);
    times.forget_changes();
    EXPECT_TRUE(times.empty());
    EXPECT_FALSE(times.find(1));
    EXPECT_EQ(times.newest(), 35);
}

// A key that is pressed four times to get from 100 to 80.
TEST(ChangeTimes, StepsInSuccessionAreOneChange)
{
    ChangeTimes times(under_way);
    note_frames(times, 20, 30);
    for (int step = 0; step < 4; step++) {
        times.note_change(6);
        note_frames(times, 4, 25 - step);
    }
    expect_times(times, 6, 30, 22);
}

} // namespace
} // namespace vkpt::tests
