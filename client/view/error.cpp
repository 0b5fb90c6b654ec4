// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/error.hpp"

#include "client/analysis/error.hpp"

#include <cmath>
#include <utility>

namespace vkpt::client::view {

void Reference::restart() { *this = {}; }

// With m the mean of n frames and h that of the first half of them, m - h = (second half - h) / 2: its variance is half
// of h's, which is that of m.
void Reference::update(analysis::LinearImage average, uint32_t frames)
{
    if (frames < frames_ || average.width != average_.width || average.height != average_.height)
        restart();
    average_ = std::move(average);
    frames_ = frames;
    if (half_frames_ == 0 || frames_ >= 2 * half_frames_) {
        if (half_frames_ > 0 && frames_ == 2 * half_frames_) {
            rmse_at_double_ = analysis::measure_error(average_, half_).rmse;
            measured_frames_ = frames_;
        }
        half_ = average_;
        half_frames_ = frames_;
    }
}

std::optional<double> Reference::own_rmse() const
{
    if (measured_frames_ == 0)
        return std::nullopt;
    return rmse_at_double_ * std::sqrt(double(measured_frames_) / double(frames_));
}

} // namespace vkpt::client::view
