// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/analysis/error.hpp"

#include "common/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace vkpt::analysis {

namespace {

void check_sizes(const LinearImage& a, const LinearImage& b)
{
    if (a.width != b.width || a.height != b.height || a.rgb.size() != b.rgb.size() || a.rgb.empty())
        throw std::invalid_argument("pictures of different sizes, or empty ones, cannot be compared");
}

double scale_of(const LinearImage& reference)
{
    const double mean = mean_luminance(reference);
    return mean > 0 ? mean : 1;
}

} // namespace

ImageError measure_error(const LinearImage& reference, const LinearImage& image)
{
    check_sizes(reference, image);
    const std::vector<float> truth = luminances(reference), values = luminances(image);
    const double n = double(truth.size()), mean = scale_of(reference);
    double squares = 0, relative = 0, difference = 0;
    for (size_t i = 0; i < truth.size(); i++) {
        const double t = double(truth[i]), error = double(values[i]) - t;
        squares += error * error;
        relative += error * error / (t * t + 1e-4 * mean * mean);
        difference += error;
    }
    return { std::sqrt(squares / n) / mean, relative / n, difference / n / mean };
}

ImageError average_errors(std::span<const ImageError> errors)
{
    ImageError sum;
    const double n = double(std::max<size_t>(errors.size(), 1));
    for (const ImageError& error : errors) {
        sum.rmse += error.rmse * error.rmse / n;
        sum.relative_mse += error.relative_mse / n;
        sum.mean_difference += error.mean_difference / n;
    }
    sum.rmse = std::sqrt(sum.rmse);
    return sum;
}

std::vector<double> relative_errors(const LinearImage& reference, const LinearImage& image)
{
    check_sizes(reference, image);
    const std::vector<float> truth = luminances(reference), values = luminances(image);
    const double floor = 0.01 * scale_of(reference);
    std::vector<double> errors(truth.size());
    for (size_t i = 0; i < truth.size(); i++)
        errors[i] = (double(values[i]) - double(truth[i])) / (double(truth[i]) + floor);
    return errors;
}

double measure_specks(const LinearImage& reference, const LinearImage& image)
{
    check_sizes(reference, image);
    const std::vector<float> truth = luminances(reference), values = luminances(image);
    const double floor = 0.02 * scale_of(reference);
    std::vector<double> ratios(truth.size());
    for (size_t i = 0; i < truth.size(); i++)
        ratios[i] = (double(values[i]) + floor) / (double(truth[i]) + floor);
    constexpr int reach = 3;
    const auto median_around = [&](int x, int y) {
        std::vector<double> around;
        for (int row = y - reach; row <= y + reach; row++)
            for (int column = x - reach; column <= x + reach; column++)
                around.push_back(ratios[size_t(std::clamp(row, 0, image.height - 1)) * size_t(image.width)
                    + size_t(std::clamp(column, 0, image.width - 1))]);
        return find_median(std::move(around));
    };
    size_t count = 0;
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            const double ratio = ratios[size_t(y) * size_t(image.width) + size_t(x)];
            count += ratio > speck_factor && ratio > speck_factor * median_around(x, y);
        }
    return double(count) / double(ratios.size());
}

double student_quantile(size_t degrees_of_freedom)
{
    // The first ones as tabulated; then the Cornish-Fisher expansion about the normal quantile (Abramowitz and Stegun
    // 26.7.5), right to three digits from there on.
    constexpr double table[] = { 12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060 };
    if (degrees_of_freedom == 0)
        return std::numeric_limits<double>::infinity();
    if (degrees_of_freedom <= std::size(table))
        return table[degrees_of_freedom - 1];
    constexpr double z = 1.959964;
    const double n = double(degrees_of_freedom), z2 = z * z;
    return z + z * (z2 + 1) / (4 * n) + z * ((5 * z2 + 16) * z2 + 3) / (96 * n * n)
        + z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * n * n * n);
}

Estimate estimate_mean(std::span<const double> numbers)
{
    const double n = double(numbers.size());
    Estimate result { 0, std::numeric_limits<double>::infinity() };
    for (const double number : numbers)
        result.mean += number / n;
    if (numbers.size() < 2)
        return result;
    double squares = 0;
    for (const double number : numbers)
        squares += (number - result.mean) * (number - result.mean);
    result.interval = student_quantile(numbers.size() - 1) * std::sqrt(squares / (n - 1) / n);
    return result;
}

Estimate estimate_bias(std::span<const double> runs, double reference_interval)
{
    Estimate bias = estimate_mean(runs);
    bias.interval = std::hypot(bias.interval, reference_interval);
    return bias;
}

std::vector<double> block_differences(const LinearImage& reference, const LinearImage& image, int side)
{
    check_sizes(reference, image);
    const int columns = (image.width + side - 1) / side, rows = (image.height + side - 1) / side;
    std::vector<double> sums(size_t(columns) * size_t(rows), 0), counts(sums.size(), 0);
    const double mean = scale_of(reference);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width; x++) {
            const size_t pixel = size_t(y) * size_t(image.width) + size_t(x);
            const size_t block = size_t(y / side) * size_t(columns) + size_t(x / side);
            sums[block] += double(luminance(&image.rgb[3 * pixel]) - luminance(&reference.rgb[3 * pixel]));
            counts[block]++;
        }
    for (size_t i = 0; i < sums.size(); i++)
        sums[i] /= counts[i] * mean;
    return sums;
}

LocalBias estimate_local_bias(std::span<const std::vector<double>> runs, std::span<const double> reference_variances)
{
    if (runs.size() < 2)
        return {};
    const double n = double(runs.size());
    double squares = 0, chance = 0;
    for (size_t block = 0; block < runs[0].size(); block++) {
        double mean = 0, variance = 0;
        for (const std::vector<double>& run : runs)
            mean += run[block] / n;
        for (const std::vector<double>& run : runs)
            variance += (run[block] - mean) * (run[block] - mean) / (n - 1);
        squares += mean * mean;
        chance += variance / n + reference_variances[block];
    }
    const double blocks = double(runs[0].size());
    return { std::sqrt(std::max(squares - chance, 0.0) / blocks), chance > 0 ? squares / chance : 0 };
}

double measure_flicker(std::span<const LinearImage> references, std::span<const LinearImage> frames)
{
    if (references.empty() || (references.size() != 1 && references.size() != frames.size()))
        throw std::invalid_argument("measure_flicker wants one reference, or one a frame");
    if (frames.size() < 2)
        return 0;
    const bool is_still = references.size() == 1;
    double squares = 0, mean = 0;
    for (const LinearImage& reference : references)
        mean += scale_of(reference) / double(references.size());
    std::vector<float> before, truth_before;
    for (size_t frame = 0; frame < frames.size(); frame++) {
        check_sizes(references[is_still ? 0 : frame], frames[frame]);
        std::vector<float> values = luminances(frames[frame]);
        std::vector<float> truth = is_still ? std::vector<float>(values.size(), 0.0f) : luminances(references[frame]);
        if (frame > 0)
            for (size_t i = 0; i < values.size(); i++) {
                const double change = double(values[i] - before[i]) - double(truth[i] - truth_before[i]);
                squares += change * change / double(values.size());
            }
        before = std::move(values);
        truth_before = std::move(truth);
    }
    return std::sqrt(squares / double(frames.size() - 1)) / mean;
}

} // namespace vkpt::analysis
