// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/overlay/times_lines.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

// The figure in a line: behind the name.
double figure_of(const PanelLine& line)
{
    const size_t start = line.text.find_first_of("0123456789", 22);
    return std::atof(line.text.c_str() + start);
}

TEST(TimesLines, SumIsThatOfThePasses)
{
    const std::vector<PassTime> passes { { "primary_visibility", 3.25 }, { "direct_light", 6.5 },
        { "a_pass_with_a_name_that_is_longer_than_most", 0.125 }, { "2d", 0 } };
    const std::vector<PanelLine> lines = describe_passes(passes);
    ASSERT_EQ(lines.size(), passes.size() + 1);
    for (size_t i = 0; i < passes.size(); i++)
        EXPECT_NEAR(figure_of(lines[i]), passes[i].milliseconds, 1e-3) << lines[i].text;
    EXPECT_NEAR(figure_of(lines.back()), 9.875, 1e-3);
    EXPECT_TRUE(lines.back().marked);
    const auto bar = [&](size_t i) { return std::ranges::count(lines[i].text, '='); };
    EXPECT_EQ(bar(1), 6);
    EXPECT_EQ(bar(0), 3);
    EXPECT_EQ(bar(3), 0);
}

TEST(TimesLines, RateIsOverHalfASecond)
{
    FrameRate rate;
    const auto moment = [](double seconds) {
        return FrameRate::Clock::time_point(std::chrono::seconds(1000))
            + std::chrono::duration_cast<FrameRate::Clock::duration>(std::chrono::duration<double>(seconds));
    };
    for (int frame = 0; frame <= 20; frame++) // 40 a second
        rate.count(moment(frame / 40.0));
    EXPECT_NEAR(rate.frames_per_second(), 40, 1e-6);
    for (int frame = 1; frame < 5; frame++)
        rate.count(moment(0.5 + frame / 10.0));
    EXPECT_NEAR(rate.frames_per_second(), 40, 1e-6) << "not before another half second";
    rate.count(moment(1));
    EXPECT_NEAR(rate.frames_per_second(), 10, 1e-6);
}

} // namespace
} // namespace vkpt::tests
