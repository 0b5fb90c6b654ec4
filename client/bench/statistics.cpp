// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/bench/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace vkpt::client {

namespace {

constexpr int resamples = 1000;
constexpr double interval_low = 0.025, interval_high = 0.975;

// As many values as there are, in blocks of neighbours that begin anywhere.
std::vector<float> resample(std::span<const float> values, size_t block, std::minstd_rand& random)
{
    std::vector<float> drawn;
    drawn.reserve(values.size());
    while (drawn.size() < values.size()) {
        const size_t start = random() % (values.size() - block + 1);
        for (size_t i = 0; i < block && drawn.size() < values.size(); i++)
            drawn.push_back(values[start + i]);
    }
    return drawn;
}

template <class Statistic> Ratio with_interval(double value, Statistic draw)
{
    std::minstd_rand random(1);
    std::vector<float> drawn;
    for (int i = 0; i < resamples; i++)
        drawn.push_back(float(draw(random)));
    return { value, find_quantile(drawn, interval_low), find_quantile(drawn, interval_high) };
}

} // namespace

Ratio find_ratio(std::span<const float> first, std::span<const float> second, size_t block)
{
    if (first.size() != second.size()) {
        const auto median = [](std::span<const float> values) {
            return find_median(std::vector<float>(values.begin(), values.end()));
        };
        return with_interval(median(second) / double(median(first)), [&](std::minstd_rand& random) {
            const float below = find_median(resample(first, 1, random));
            return find_median(resample(second, 1, random)) / below;
        });
    }
    std::vector<float> ratios;
    for (size_t i = 0; i < first.size(); i++)
        ratios.push_back(second[i] / first[i]);
    const size_t length = std::clamp<size_t>(block, 1, ratios.size());
    return with_interval(
        find_median(ratios), [&](std::minstd_rand& random) { return find_median(resample(ratios, length, random)); });
}

} // namespace vkpt::client
