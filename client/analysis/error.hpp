// SPDX-License-Identifier: GPL-2.0-or-later
// How far pictures are from a reference: error, bias, flicker. All of linear luminance; relative ones by the reference.
#pragma once

#include "client/analysis/linear_image.hpp"

#include <span>
#include <vector>

namespace vkpt::analysis {

struct ImageError {
    double rmse = 0; // root mean square error / mean of the reference
    // Mean over pixels of error^2 / (reference^2 + 1e-4 mean^2): dark places count as much as bright ones.
    double relative_mse = 0;
    double mean_difference = 0; // (mean of the picture - mean of the reference) / mean of the reference
};

// Throws std::invalid_argument where the sizes differ. A black reference: its mean counts as 1.
ImageError measure_error(const LinearImage& reference, const LinearImage& image);
// Means over pictures: rmse is the root of the mean square.
ImageError average_errors(std::span<const ImageError> errors);

// Error of each pixel's luminance by (reference + 1 % of the reference's mean): what spectra are made of.
std::vector<double> relative_errors(const LinearImage& reference, const LinearImage& image);

// Share of pixels (0 to 1) that are specks: brighter than speck_factor times the reference, and than speck_factor times
// the median of the pixels around (7 x 7) in the ratio of picture to reference. Both have 2 % of the reference's mean
// added. So a place that is too bright as a whole is none.
inline constexpr double speck_factor = 1.6;
double measure_specks(const LinearImage& reference, const LinearImage& image);

// A mean and the half width of its 95 % confidence interval.
struct Estimate {
    double mean = 0, interval = 0;
};
// Of independent numbers, by Student's distribution. Fewer than two have an infinite interval.
Estimate estimate_mean(std::span<const double> numbers);
// Two-sided 95 % quantile of Student's distribution.
double student_quantile(size_t degrees_of_freedom);

// Systematic error of independent runs. `runs` are their mean_difference; `reference` the interval of the reference's
// own mean, relative to that mean: independent of the runs.
Estimate estimate_bias(std::span<const double> runs, double reference_interval);

// Mean difference of square blocks of `side` pixels, relative to the reference's mean: where a sampler is too bright
// here and too dark there the picture's mean does not tell. Row by row; blocks at the right and lower edge may be
// smaller.
std::vector<double> block_differences(const LinearImage& reference, const LinearImage& image, int side);

// Root mean square over blocks of what is systematic in their differences: from independent runs, each one's block
// differences, the mean square of the blocks' means less what chance makes of it. 0 where chance explains them.
struct LocalBias {
    double rms = 0;
    double excess = 0; // mean square by what chance would make of it: about 1 without bias
};
LocalBias estimate_local_bias(std::span<const std::vector<double>> runs, std::span<const double> reference_variances);

// Root mean square, over pixels and pairs of neighbouring frames, of (change of the picture - change of the reference),
// by the mean of the references: what flickers although the scene does not. One reference, or one a frame.
double measure_flicker(std::span<const LinearImage> references, std::span<const LinearImage> frames);

} // namespace vkpt::analysis
