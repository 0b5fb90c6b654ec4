// SPDX-License-Identifier: GPL-2.0-or-later
// Order statistics.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace vkpt {

// Nearest rank: the smallest value that at least `fraction` (0..1] of all do not exceed. Empty: 0.
template <class Number> Number find_quantile(std::vector<Number> values, double fraction)
{
    if (values.empty())
        return 0;
    const double rank = std::ceil(fraction * double(values.size())) - 1;
    const auto place = values.begin() + std::ptrdiff_t(std::clamp(rank, 0.0, double(values.size() - 1)));
    std::ranges::nth_element(values, place);
    return *place;
}
template <class Number> Number find_median(std::vector<Number> values) { return find_quantile(std::move(values), 0.5); }

} // namespace vkpt
