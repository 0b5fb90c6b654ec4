// SPDX-License-Identifier: GPL-2.0-or-later
// The converged picture that errors are measured against, while it is still converging.
#pragma once

#include "client/analysis/linear_image.hpp"

#include <cstdint>
#include <optional>

namespace vkpt::client::view {

// An average that grows, and what is known of its own error.
class Reference {
public:
    void restart();
    // The average of so many frames. The counts grow from call to call.
    void update(analysis::LinearImage average, uint32_t frames);

    const analysis::LinearImage& average() const { return average_; }
    uint32_t frames() const { return frames_; }
    // RMSE of the average itself, as of analysis::measure_error: two halves of independent frames differ by twice that
    // of their mean. Nothing: too few frames yet.
    std::optional<double> own_rmse() const;

private:
    analysis::LinearImage average_, half_; // half_: the average when it held half as many frames
    uint32_t frames_ = 0, half_frames_ = 0;
    double rmse_at_double_ = 0; // the error when half_frames_ had doubled
    uint32_t measured_frames_ = 0;
};

} // namespace vkpt::client::view
