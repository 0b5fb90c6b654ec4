// SPDX-License-Identifier: GPL-2.0-or-later
#include "tools/calibrate_light/fit.hpp"

#include <algorithm>
#include <cmath>

namespace vkpt::tools {

namespace {

constexpr double min_ratio = 1e-3; // unlit luxels must not pull the mean of logarithms to minus infinity
constexpr double spread_weight = 0.2;
constexpr double present_share = 0.01; // of all traced light: a kind with less cannot be fitted

double measure_misfit(const std::vector<MapComparison>& maps, const Scales& factors)
{
    double misfit = 0;
    for (const MapComparison& map : maps) {
        if (map.luxels.empty())
            continue;
        const Quartiles ratio = measure_ratio(map, factors);
        double spread = 0;
        for (const Comparison& luxel : map.luxels)
            spread += std::abs(std::log(std::max(luxel.traced_with(factors) / luxel.baked, min_ratio)));
        misfit += std::abs(std::log(std::max(ratio.median, min_ratio)))
            + spread_weight * spread / double(map.luxels.size());
    }
    return misfit;
}

std::array<bool, light_kind_count> find_present_kinds(const std::vector<MapComparison>& maps)
{
    Scales sums {};
    double all = 0;
    for (const MapComparison& map : maps)
        for (const Comparison& luxel : map.luxels)
            for (size_t kind = 0; kind < light_kind_count; kind++) {
                sums[kind] += luxel.traced[kind];
                all += luxel.traced[kind];
            }
    std::array<bool, light_kind_count> present {};
    for (size_t kind = 0; kind < light_kind_count; kind++)
        present[kind] = sums[kind] > present_share * all;
    return present;
}

} // namespace

double Comparison::traced_with(const Scales& factors) const
{
    double sum = 0;
    for (size_t kind = 0; kind < light_kind_count; kind++)
        sum += factors[kind] * traced[kind];
    return sum;
}

Quartiles measure_ratio(const MapComparison& map, const Scales& factors)
{
    if (map.luxels.empty())
        return {};
    std::vector<double> ratios;
    for (const Comparison& luxel : map.luxels)
        ratios.push_back(luxel.traced_with(factors) / luxel.baked);
    std::sort(ratios.begin(), ratios.end());
    const auto at = [&](double share) { return ratios[size_t(share * double(ratios.size() - 1))]; };
    return { at(0.25), at(0.5), at(0.75) };
}

// Pattern search over the logarithms: the misfit has kinks, and three unknowns are few.
Scales fit_factors(const std::vector<MapComparison>& maps)
{
    const std::array<bool, light_kind_count> present = find_present_kinds(maps);
    Scales best;
    best.fill(1);
    double best_misfit = measure_misfit(maps, best);
    for (double step = 2; step > 0.005; step *= 0.5)
        for (bool improved = true; improved;) {
            improved = false;
            for (size_t kind = 0; kind < light_kind_count; kind++)
                for (const double direction : { step, -step }) {
                    Scales candidate = best;
                    candidate[kind] *= std::exp(direction);
                    const double misfit = measure_misfit(maps, candidate);
                    if (!present[kind] || misfit >= best_misfit - 1e-9)
                        continue;
                    best = candidate;
                    best_misfit = misfit;
                    improved = true;
                }
        }
    return best;
}

} // namespace vkpt::tools
