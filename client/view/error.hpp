// SPDX-License-Identifier: GPL-2.0-or-later
// How far a picture is from the converged one, while that is still converging.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vkpt::client::view {

// Of linear radiance, over all pixels and channels.
struct ErrorFigures {
    double rmse = 0;
    double relative_mse = 0; // mean of (x - r)^2 / (r^2 + 0.01)
};
ErrorFigures measure_error(std::span<const float> picture, std::span<const float> reference);

// The reference: an average that grows, and what is known of its own error.
class Reference {
public:
    void restart();
    // The average of so many frames, RGB. The counts grow from call to call.
    void update(std::span<const float> average, uint32_t frames);

    const std::vector<float>& average() const { return average_; }
    uint32_t frames() const { return frames_; }
    // RMSE of the average itself: two halves of independent frames differ by twice that of their mean. Nothing: too few
    // frames yet.
    std::optional<double> own_rmse() const;

private:
    std::vector<float> average_, half_; // half_: the average when it held half as many frames
    uint32_t frames_ = 0, half_frames_ = 0;
    double rmse_at_double_ = 0; // the error when half_frames_ had doubled
    uint32_t measured_frames_ = 0;
};

} // namespace vkpt::client::view
