// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/overlay/change_times.hpp"

#include "common/quantile.hpp"

#include <algorithm>

namespace vkpt {

double ChangeTimes::median_of_last(size_t frames) const
{
    return find_median(std::vector(newest_.end() - std::ptrdiff_t(std::min(frames, newest_.size())), newest_.end()));
}

void ChangeTimes::note_frame(double milliseconds)
{
    if (newest_.size() == counted)
        newest_.erase(newest_.begin());
    newest_.push_back(milliseconds);
    if (++since_ > under_way_ && !changes_.empty())
        changes_.back().times.after = median_of_last(since_ - under_way_);
}

void ChangeTimes::note_change(size_t row)
{
    const bool goes_on = !changes_.empty() && changes_.back().row == row && since_ < under_way_ + counted;
    if (!goes_on) {
        std::erase_if(changes_, [&](const Change& change) { return change.row == row; });
        changes_.push_back({ row, { newest(), 0 } });
    }
    changes_.back().times.after = 0;
    since_ = 0;
}

std::optional<ChangeTimes::Pair> ChangeTimes::find(size_t row) const
{
    const auto change = std::ranges::find(changes_, row, &Change::row);
    return change != changes_.end() ? std::optional(change->times) : std::nullopt;
}

} // namespace vkpt
