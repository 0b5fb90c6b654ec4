// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/rays/trace_ranking.hpp"

#include "common/quantile.hpp"

#include <algorithm>

namespace vkpt {

std::optional<TraceRanking> rank_traces(std::span<const std::vector<double>> times)
{
    constexpr double min_difference = 1.03, lower_quartile = 0.25, upper_quartile = 0.75;
    TraceRanking ranking;
    for (const std::vector<double>& of_one : times)
        ranking.medians.push_back(find_median(of_one));
    if (ranking.medians.empty() || std::ranges::min(ranking.medians) <= 0)
        return std::nullopt;
    ranking.fastest = size_t(std::ranges::min_element(ranking.medians) - ranking.medians.begin());
    ranking.is_clear = true;
    const double slow_best = find_quantile(times[ranking.fastest], upper_quartile);
    for (size_t i = 0; i < times.size(); i++)
        if (i != ranking.fastest)
            ranking.is_clear &= ranking.medians[i] > min_difference * ranking.medians[ranking.fastest]
                && find_quantile(times[i], lower_quartile) > slow_best;
    return ranking;
}

} // namespace vkpt
