// SPDX-License-Identifier: GPL-2.0-or-later
// What a frame took before and after each of the settings was changed.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace vkpt {

class ChangeTimes {
public:
    static constexpr size_t counted = 15; // frames; medians of so many

    struct Pair {
        double before, after; // milliseconds; 0: of no frame yet
    };

    // So many frames are under way when a setting changes: their times come later.
    explicit ChangeTimes(size_t frames_under_way)
        : under_way_(frames_under_way)
    {
    }

    void forget_changes() { changes_.clear(); }
    void note_frame(double milliseconds);
    // The frames from here on are others. Steps of one row in quick succession are one change.
    void note_change(size_t row);

    double newest() const { return median_of_last(counted); }
    // Nothing: that row was not changed.
    std::optional<Pair> find(size_t row) const;
    bool empty() const { return changes_.empty(); }

private:
    struct Change {
        size_t row;
        Pair times;
    };

    double median_of_last(size_t frames) const;

    size_t under_way_;
    std::vector<double> newest_; // milliseconds, the oldest first
    std::vector<Change> changes_; // one a row, the newest last
    size_t since_ = 0; // frames noted since then
};

} // namespace vkpt
