// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/graph.hpp"

#include "common/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vkpt::client::view {

void PassHistory::add(const std::vector<PassRow>& passes)
{
    frames_.push_back(passes);
    if (frames_.size() > kept_frames)
        frames_.pop_front();
}

std::vector<std::string> PassHistory::names() const
{
    std::vector<std::string> names;
    for (const std::vector<PassRow>& frame : frames_)
        for (const PassRow& row : frame)
            if (!std::ranges::count(names, row.name))
                names.push_back(row.name);
    return names;
}

double PassHistory::milliseconds(size_t frame, std::string_view name) const
{
    const auto found = std::ranges::find(frames_[frame], name, &PassRow::name);
    return found == frames_[frame].end() ? 0 : found->milliseconds;
}

double PassHistory::total(size_t frame) const
{
    double sum = 0;
    for (const PassRow& row : frames_[frame])
        sum += row.milliseconds;
    return sum;
}

double PassHistory::median(std::string_view name) const
{
    std::vector<double> times;
    for (const std::vector<PassRow>& frame : frames_)
        if (const auto found = std::ranges::find(frame, name, &PassRow::name); found != frame.end())
            times.push_back(found->milliseconds);
    return find_median(std::move(times));
}

double PassHistory::scale() const
{
    std::vector<double> totals;
    for (size_t frame = 0; frame < frames_.size(); frame++)
        totals.push_back(total(frame));
    if (totals.empty())
        return 1;
    std::ranges::sort(totals);
    constexpr double headroom = 1.8;
    return round_up(std::min(totals.back(), headroom * totals[totals.size() / 2]));
}

double round_up(double value)
{
    if (!(value > 0))
        return 1;
    const double power = std::pow(10, std::floor(std::log10(value)));
    for (const double factor : { 1.0, 2.0, 5.0 })
        if (value <= factor * power)
            return factor * power;
    return 10 * power;
}

void ErrorHistory::add(const analysis::ImageError& error)
{
    figures.push_back(error);
    if (figures.size() > kept_frames)
        figures.pop_front();
}

} // namespace vkpt::client::view
