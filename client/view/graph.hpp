// SPDX-License-Identifier: GPL-2.0-or-later
// What the passes of the last frames took, stacked over time, and the error's way down.
#pragma once

#include "client/view/render_thread.hpp"

#include <deque>

namespace vkpt::client::view {

inline constexpr size_t kept_frames = 120;

class PassHistory {
public:
    void add(const std::vector<PassRow>& passes);
    void clear() { frames_.clear(); }

    // Rows in the order of their first appearance; names of passes that have not run in any kept frame are gone.
    std::vector<std::string> names() const;
    // Milliseconds of a pass in the n-th kept frame, the oldest first; 0: it did not run.
    double milliseconds(size_t frame, std::string_view name) const;
    double total(size_t frame) const;
    // Over the kept frames in which the pass ran.
    double median(std::string_view name) const;
    size_t size() const { return frames_.size(); }
    // Milliseconds that a graph should reach to: round, and not led by a few frames in which shaders were compiled.
    double scale() const;

private:
    std::deque<std::vector<PassRow>> frames_;
};

// The next 1, 2 or 5 times a power of ten that is not less.
double round_up(double value);

// The last errors against the reference, and how many frames that held.
struct ErrorHistory {
    std::deque<analysis::ImageError> figures;
    void add(const analysis::ImageError& error);
};

} // namespace vkpt::client::view
