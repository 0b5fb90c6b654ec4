// SPDX-License-Identifier: GPL-2.0-or-later
// Order statistics of measured times, and how sure a ratio of two of them is.
#pragma once

#include <span>
#include <vector>

namespace vkpt::client {

// Nearest rank: the smallest value that at least `fraction` (0..1] of all do not exceed. Empty: 0.
float find_quantile(std::vector<float> values, double fraction);
float find_median(std::vector<float> values);

struct Ratio {
    double value = 1;
    double low = 1, high = 1; // 95 % confidence interval
};
// Of `second` to `first`, by bootstrap (Efron, "Bootstrap Methods: Another Look at the Jackknife", 1979) with fixed
// random numbers. As many values of both: those of one place belong together, and the median of their ratios is taken;
// `block` neighbours are drawn together, because they are alike (Künsch, "The Jackknife and the Bootstrap for General
// Stationary Observations", 1989). Else the ratio of the medians. Neither is empty; all are above 0.
Ratio find_ratio(std::span<const float> first, std::span<const float> second, size_t block);

} // namespace vkpt::client
