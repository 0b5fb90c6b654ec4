// SPDX-License-Identifier: GPL-2.0-or-later
// pt_show_times: what a frame takes, on the screen.
#pragma once

#include "ref_vkpt/extension.hpp"
#include "ref_vkpt/overlay/panel.hpp"

#include <chrono>
#include <string>
#include <vector>

namespace vkpt {

// Frames a second, over half a second each time, so that they can be read.
class FrameRate {
public:
    using Clock = std::chrono::steady_clock;
    void count(Clock::time_point now);
    double frames_per_second() const { return rate_; }

private:
    Clock::time_point since_ {};
    int frames_ = 0;
    double rate_ = 0;
};

// A bar and a figure for each pass, and their sum: the frame's time on the device.
std::vector<PanelLine> describe_passes(const std::vector<PassTime>& passes);

} // namespace vkpt
