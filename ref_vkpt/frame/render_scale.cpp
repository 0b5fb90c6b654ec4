// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/render_scale.hpp"

#include "common/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkpt {

namespace {

constexpr size_t frames_measured = 5;
constexpr uint32_t frames_under_way = 3;
// Shares of the target: above the first the size shrinks; it grows where the larger size should stay below the second.
// What lies between keeps the size from swinging.
constexpr double too_slow = 1.03, fast_enough = 0.93;

} // namespace

uint32_t RenderScale::percent(const Limits& limits) const
{
    if (limits.target_ms <= 0)
        return limits.highest;
    return std::clamp(percent_, std::min(limits.lowest, limits.highest), limits.highest);
}

void RenderScale::add_frame(double milliseconds, const Limits& limits)
{
    if (limits.target_ms <= 0 || milliseconds <= 0) {
        times_.clear();
        return;
    }
    if (frames_to_skip_ > 0) {
        frames_to_skip_--;
        return;
    }
    times_.push_back(milliseconds);
    if (times_.size() < frames_measured)
        return;
    const double median = find_median(std::exchange(times_, {}));
    // Time goes with the pixels, that is with the square; rounded down to a whole step.
    const uint32_t now = percent(limits);
    const double share = limits.target_ms / median;
    const auto reachable = [&](double bound) { return uint32_t(now * std::sqrt(share * bound)) / step * step; };
    uint32_t next = now;
    if (median > too_slow * limits.target_ms)
        next = std::min(now, reachable(1));
    else
        next = std::max(now, reachable(fast_enough));
    percent_ = next;
    percent_ = percent(limits);
    if (percent_ != now)
        frames_to_skip_ = frames_under_way;
}

} // namespace vkpt
