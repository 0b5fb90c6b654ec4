// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/overlay/times_lines.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkpt {

namespace {

constexpr int bar_columns = 6; // of the longest pass
constexpr int name_columns = 22;

std::string describe(std::string_view name, double milliseconds)
{
    return fmt::format("{:{}.{}} {:8.3f}", name, name_columns, name_columns, milliseconds);
}

} // namespace

void FrameRate::count(Clock::time_point now)
{
    constexpr double min_seconds = 0.5;
    if (since_ == Clock::time_point())
        since_ = now;
    else
        frames_++;
    const double seconds = std::chrono::duration<double>(now - since_).count();
    if (seconds < min_seconds)
        return;
    rate_ = frames_ / seconds;
    since_ = now;
    frames_ = 0;
}

std::vector<PanelLine> describe_passes(const std::vector<PassTime>& passes)
{
    double sum = 0, longest = 0;
    for (const PassTime& pass : passes) {
        sum += pass.milliseconds;
        longest = std::max(longest, pass.milliseconds);
    }
    std::vector<PanelLine> lines;
    for (const PassTime& pass : passes) {
        const double share = longest > 0 ? pass.milliseconds / longest : 0;
        const auto bar = size_t(std::lround(bar_columns * std::clamp(share, 0.0, 1.0)));
        lines.push_back({ describe(pass.name, pass.milliseconds) + " " + std::string(bar, '=')
            + std::string(bar_columns - bar, ' ') });
    }
    lines.push_back({ describe("all passes, ms", sum), true });
    return lines;
}

} // namespace vkpt
