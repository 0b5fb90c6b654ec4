// SPDX-License-Identifier: GPL-2.0-or-later
// The masks that the build made, as the shaders look them up, and the tool that makes them.
#include "client/analysis/spectrum.hpp"
#include "glsl_libraries.hpp"
#include "ref_vkpt/noise/blue_noise.hpp"
#include "tools/blue_noise/void_and_cluster.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace vkpt::test {
namespace {

using namespace glsl;
using analysis::measure_spectrum;
using analysis::Spectrum;

constexpr size_t side = BLUE_NOISE_SIZE, slice_size = side * side, voxels = slice_size * BLUE_NOISE_SLICES;

// The 16-bit values of a mask, slice by slice.
std::vector<uint32_t> mask_values(uint mask)
{
    std::vector<uint32_t> values(voxels);
    for (size_t i = 0; i < voxels; i++)
        values[i] = blue_noise_words[mask / 2 * voxels + i] >> (mask % 2 * 16) & 0xffffu;
    return values;
}

std::vector<double> slice_of(const std::vector<uint32_t>& mask, size_t slice)
{
    const auto first = mask.begin() + ptrdiff_t(slice * slice_size);
    return { first, first + ptrdiff_t(slice_size) };
}

double correlation_of(const std::vector<double>& a, const std::vector<double>& b)
{
    double mean_a = 0, mean_b = 0, ab = 0, aa = 0, bb = 0;
    for (size_t i = 0; i < a.size(); i++) {
        mean_a += a[i] / double(a.size());
        mean_b += b[i] / double(a.size());
    }
    for (size_t i = 0; i < a.size(); i++) {
        ab += (a[i] - mean_a) * (b[i] - mean_b);
        aa += (a[i] - mean_a) * (a[i] - mean_a);
        bb += (b[i] - mean_b) * (b[i] - mean_b);
    }
    return ab / std::sqrt(aa * bb);
}

std::vector<double> picture_of(uint frame, uint seed, uint dimension)
{
    std::vector<double> numbers;
    for (uint y = 0; y < side; y++)
        for (uint x = 0; x < side; x++)
            numbers.push_back(blue_dimension(
                { blue_noise_words.data() }, uvec2(x, y), frame, blue_period_key(frame, seed), dimension));
    return numbers;
}

TEST(BlueNoise, EveryValueAppearsOnceInAMask)
{
    for (uint mask = 0; mask < BLUE_NOISE_MASKS; mask++) {
        std::vector<uint32_t> values = mask_values(mask);
        std::sort(values.begin(), values.end());
        for (uint32_t i = 0; i < voxels; i++)
            ASSERT_EQ(values[i], i) << "mask " << mask;
    }
}

// Each of 4096 equal intervals holds one pixel of each slice.
TEST(BlueNoise, EverySliceIsUniform)
{
    for (uint mask = 0; mask < BLUE_NOISE_MASKS; mask++)
        for (size_t slice = 0; slice < BLUE_NOISE_SLICES; slice++) {
            std::vector<double> values = slice_of(mask_values(mask), slice);
            std::sort(values.begin(), values.end());
            for (size_t i = 0; i < slice_size; i++)
                ASSERT_EQ(uint32_t(values[i]) / BLUE_NOISE_SLICES, i) << "mask " << mask << ", slice " << slice;
        }
}

TEST(BlueNoise, LowFrequenciesAreWeakInEverySlice)
{
    const double white = double(voxels) * double(voxels) / 12; // variance: white noise's power at every frequency
    double worst = 0;
    for (uint mask = 0; mask < BLUE_NOISE_MASKS; mask++)
        for (size_t slice = 0; slice < BLUE_NOISE_SLICES; slice++) {
            const Spectrum spectrum = measure_spectrum(slice_of(mask_values(mask), slice), side);
            worst = std::max(worst, spectrum.low / white);
            EXPECT_LT(spectrum.low_to_high(), 0.01) << "mask " << mask << ", slice " << slice;
            EXPECT_GT(spectrum.high, white);
        }
    fmt::print("strongest low frequencies: {:.4f} of white noise\n", worst);
    EXPECT_LT(worst, 0.01);
}

// So is the picture of pixels below any threshold: what a choice between two lights makes of the numbers.
TEST(BlueNoise, ThresholdsOfASliceAreBlue)
{
    for (const double threshold : { 0.1, 0.3, 0.5, 0.7, 0.9 }) {
        std::vector<std::vector<double>> pictures;
        for (uint mask = 0; mask < BLUE_NOISE_MASKS; mask++) {
            std::vector<double> picture = slice_of(mask_values(mask), 3);
            for (double& value : picture)
                value = value < threshold * double(voxels);
            pictures.push_back(picture);
        }
        EXPECT_LT(measure_spectrum(pictures, side).low_to_high(), 0.3) << threshold;
    }
}

// A pixel's numbers over the frames of a period: the sum of a few consecutive ones varies less than of independent
// ones.
TEST(BlueNoise, ConsecutiveFramesDiffer)
{
    for (uint mask = 0; mask < BLUE_NOISE_MASKS; mask++) {
        const std::vector<uint32_t> values = mask_values(mask);
        double variance = 0;
        for (size_t pixel = 0; pixel < slice_size; pixel++)
            for (size_t first = 0; first < BLUE_NOISE_SLICES; first++) {
                double mean = 0;
                for (size_t i = 0; i < 4; i++)
                    mean += (values[(first + i) % BLUE_NOISE_SLICES * slice_size + pixel] / double(voxels) - 0.5) / 4;
                variance += mean * mean / double(voxels);
            }
        EXPECT_LT(variance / (1.0 / 12 / 4), 0.5) << "mask " << mask;
    }
}

TEST(BlueNoise, MasksAndDimensionsAreUncorrelated)
{
    const double plausible = 5 / std::sqrt(double(slice_size));
    for (uint frame = 0; frame < 40; frame += 13) {
        std::vector<std::vector<double>> pictures;
        for (uint dimension = 0; dimension < 12; dimension++)
            pictures.push_back(picture_of(frame, 5, dimension));
        pictures.push_back(picture_of(frame, 6, 0));
        pictures.push_back(picture_of(frame + BLUE_NOISE_SLICES, 5, 0));
        for (size_t a = 0; a < pictures.size(); a++)
            for (size_t b = a + 1; b < pictures.size(); b++)
                EXPECT_LT(std::abs(correlation_of(pictures[a], pictures[b])), plausible) << a << ", " << b;
    }
}

// What accumulation relies on: over many frames one pixel's numbers are uniform, pairs of dimensions fill the square.
TEST(BlueNoise, APixelsNumbersFillTheSquareOverTheFrames)
{
    constexpr int frames = 1 << 17, bins = 16;
    std::vector<double> counts(bins * bins, 0);
    for (uint frame = 0; frame < frames; frame++) {
        const auto number = [&](uint dimension) {
            return blue_dimension(
                { blue_noise_words.data() }, uvec2(17, 40), frame, blue_period_key(frame, 3), dimension);
        };
        counts[size_t(number(16) * bins) * bins + size_t(number(20) * bins)]++; // both of one mask
    }
    const double expected = double(frames) / double(counts.size());
    double chi_square = 0;
    for (const double count : counts)
        chi_square += (count - expected) * (count - expected) / expected;
    EXPECT_LT(chi_square, 255 + 5 * std::sqrt(2.0 * 255));
}

TEST(BlueNoise, CanBeReplayedAndStaysBelowOne)
{
    Random first = make_blue_random({ blue_noise_words.data() }, uvec2(9, 11), 1000, 4), again = first;
    for (int i = 0; i < 100; i++) {
        const float number = next_float(first);
        ASSERT_EQ(number, next_float(again));
        ASSERT_GE(number, 0.0f);
        ASSERT_LT(number, 1.0f);
    }
}

TEST(BlueNoise, TheToolRepeatsItself)
{
    const std::vector<uint32_t> first = mask_values(0);
    EXPECT_EQ(blue_noise::make_mask({}), first);
    blue_noise::MaskSettings small;
    small.shape = { 32, 4 };
    small.seed = 9;
    const std::vector<uint32_t> nine = blue_noise::make_mask(small);
    EXPECT_EQ(nine, blue_noise::make_mask(small));
    small.seed = 10;
    EXPECT_NE(nine, blue_noise::make_mask(small));
}

} // namespace
} // namespace vkpt::test
