// SPDX-License-Identifier: GPL-2.0-or-later
// Which of several ways to trace was measured to be the fastest, and whether that can be relied on. No Vulkan.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace vkpt {

struct TraceRanking {
    size_t fastest = 0;
    bool is_clear = false; // else chance, or a hiccup, may have decided
    std::vector<double> medians; // nanoseconds per ray
};

// `times`: of each way, some measurements in nanoseconds per ray, taken by turns. By medians; clear where the slower
// half of the fastest's measurements, without its slowest quarter, lies below all but the fastest quarter of every
// other's, and the medians are 3 % apart. Empty: something took no time at all, the device does not measure.
std::optional<TraceRanking> rank_traces(std::span<const std::vector<double>> times);

} // namespace vkpt
