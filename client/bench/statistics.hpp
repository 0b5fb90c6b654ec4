// SPDX-License-Identifier: GPL-2.0-or-later
// How sure a ratio of measured times is.
#pragma once

#include "common/quantile.hpp"

#include <span>
#include <vector>

namespace vkpt::client {

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
