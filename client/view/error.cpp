// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/view/error.hpp"

#include <algorithm>
#include <cmath>

namespace vkpt::client::view {

ErrorFigures measure_error(std::span<const float> picture, std::span<const float> reference)
{
    constexpr double floor = 0.01; // keeps what is black in the reference from counting for everything
    double squares = 0, relative = 0;
    const size_t count = std::min(picture.size(), reference.size());
    for (size_t i = 0; i < count; i++) {
        const double r = reference[i], difference = picture[i] - r, square = difference * difference;
        squares += square;
        relative += square / (r * r + floor);
    }
    if (count == 0)
        return {};
    return { std::sqrt(squares / double(count)), relative / double(count) };
}

void Reference::restart() { *this = {}; }

// With m the mean of n frames and h that of the first half of them, m - h = (second half - h) / 2: its variance is half
// of h's, which is that of m.
void Reference::update(std::span<const float> average, uint32_t frames)
{
    if (frames < frames_ || average.size() != average_.size())
        restart();
    average_.assign(average.begin(), average.end());
    frames_ = frames;
    if (half_frames_ == 0 || frames_ >= 2 * half_frames_) {
        if (half_frames_ > 0 && frames_ == 2 * half_frames_) {
            rmse_at_double_ = measure_error(average_, half_).rmse;
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
