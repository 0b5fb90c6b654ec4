// SPDX-License-Identifier: GPL-2.0-or-later
// How many pixels a view renders, so that frames take the time that they should (pt_target_ms).
#pragma once

#include <cstdint>
#include <vector>

namespace vkpt {

class RenderScale {
public:
    struct Limits {
        float target_ms = 0; // 0: the size does not follow the time
        uint32_t lowest = 50, highest = 100; // percent of the window's width and height
    };

    // A frame has taken so long on the device. Measurements of one size are gathered, and the median counts: single
    // frames are slow for other reasons.
    void add_frame(double milliseconds, const Limits& limits);
    uint32_t percent(const Limits& limits) const;

    static constexpr uint32_t step = 5; // percent

private:
    uint32_t percent_ = 100;
    uint32_t frames_to_skip_ = 0; // that were under way at the last size
    std::vector<double> times_;
};

} // namespace vkpt
