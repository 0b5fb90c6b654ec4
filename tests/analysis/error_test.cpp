// SPDX-License-Identifier: GPL-2.0-or-later
// Error figures against numbers worked out by hand, and against what chance does.
#include "client/analysis/error.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>

namespace vkpt::tests {
namespace {

using namespace vkpt::analysis;

LinearImage grey(int width, int height, const std::vector<float>& values)
{
    LinearImage image = make_image(width, height);
    for (size_t i = 0; i < image.rgb.size(); i++)
        image.rgb[i] = values[i / 3 % values.size()];
    return image;
}

TEST(ImageError, IsWhatTheFormulasSay)
{
    const LinearImage reference = grey(2, 1, { 1, 3 }), image = grey(2, 1, { 2, 3.5f });
    const ImageError error = measure_error(reference, image);
    EXPECT_NEAR(error.rmse, std::sqrt((1 + 0.25) / 2) / 2, 1e-6);
    EXPECT_NEAR(error.mean_difference, 0.75 / 2, 1e-6);
    EXPECT_NEAR(error.relative_mse, (1 / (1 + 4e-4) + 0.25 / (9 + 4e-4)) / 2, 1e-6);
    EXPECT_EQ(measure_error(reference, reference).rmse, 0);
    EXPECT_THROW(measure_error(reference, grey(1, 2, { 1 })), std::invalid_argument);
}

TEST(ImageError, AveragesSquares)
{
    const ImageError errors[] = { { 3, 1, 0.5 }, { 4, 3, -0.5 } };
    const ImageError mean = average_errors(errors);
    EXPECT_NEAR(mean.rmse, std::sqrt(12.5), 1e-12);
    EXPECT_NEAR(mean.relative_mse, 2, 1e-12);
    EXPECT_NEAR(mean.mean_difference, 0, 1e-12);
}

TEST(Specks, ArePixelsThatStandOutOfTheirSurroundings)
{
    const LinearImage reference = grey(20, 20, { 1 });
    LinearImage image = reference;
    const auto set = [&image](int x, int y, float value) {
        for (int channel = 0; channel < 3; channel++)
            image.rgb[size_t(3 * (y * image.width + x) + channel)] = value;
    };
    EXPECT_EQ(measure_specks(reference, image), 0);
    set(10, 10, 1.7f); // (1.7 + .02) / 1.02 is more than 1.6
    set(0, 19, 5); // at the edge
    set(15, 3, 1.6f); // and this is less
    set(3, 3, 0); // dark ones are none
    EXPECT_DOUBLE_EQ(measure_specks(reference, image), 2.0 / 400);
    // The same pixels where the image is twice as bright as it should be: no more than their surroundings.
    for (float& value : image.rgb)
        value = 2;
    set(10, 10, 3);
    EXPECT_EQ(measure_specks(reference, image), 0);
    set(10, 10, 3.4f);
    EXPECT_DOUBLE_EQ(measure_specks(reference, image), 1.0 / 400);
    EXPECT_THROW(measure_specks(reference, grey(1, 2, { 1 })), std::invalid_argument);
}

TEST(Student, HasTheTablesQuantiles)
{
    const std::pair<size_t, double> rows[] = { { 15, 2.1314 }, { 30, 2.0423 }, { 1000, 1.9623 } };
    for (const auto& [degrees, quantile] : rows)
        EXPECT_NEAR(student_quantile(degrees), quantile, 4e-4) << degrees;
    EXPECT_TRUE(std::isinf(student_quantile(0)));
}

// The share of Student's distribution between -t and t (Abramowitz and Stegun 26.7.3 and 26.7.4), not a table again.
double student_share(size_t degrees, double t)
{
    const double angle = std::atan(t / std::sqrt(double(degrees))), cosine2 = std::cos(angle) * std::cos(angle);
    const bool odd = degrees % 2;
    double term = odd ? std::cos(angle) : 1, sum = degrees == 1 ? 0 : term;
    for (size_t k = odd ? 3 : 2; k + 1 < degrees; k += 2)
        sum += term *= cosine2 * double(k - 1) / double(k);
    return odd ? (angle + std::sin(angle) * sum) * 2 / std::numbers::pi : std::sin(angle) * sum;
}

// As near as 4e-4 of a quantile.
TEST(Student, QuantilesHoldNinetyFivePercent)
{
    for (size_t degrees = 1; degrees <= 40; degrees++)
        EXPECT_NEAR(student_share(degrees, student_quantile(degrees)), 0.95, 4e-5) << degrees;
}

// What a 95 % interval promises, at its smallest.
TEST(Bias, IntervalHoldsTheTruthInNineteenOfTwenty)
{
    std::mt19937 rng(3);
    std::normal_distribution<double> gauss;
    for (const size_t runs : { size_t(2), size_t(8) }) {
        int held = 0;
        constexpr int trials = 4000;
        for (int trial = 0; trial < trials; trial++) {
            std::vector<double> numbers(runs);
            for (double& number : numbers)
                number = 0.3 + gauss(rng);
            const Estimate bias = estimate_bias(numbers, 0);
            held += std::abs(bias.mean - 0.3) <= bias.interval;
        }
        EXPECT_NEAR(double(held) / trials, 0.95, 0.014) << runs;
    }
    EXPECT_TRUE(std::isinf(estimate_bias(std::vector<double> { 1 }, 0).interval));
    EXPECT_NEAR(estimate_bias(std::vector<double> { 1, 1 }, 0.25).interval, 0.25, 1e-12);
}

// Brighter on one side by as much as darker on the other: the mean is right.
TEST(LocalBias, FindsWhatTheMeanHides)
{
    std::mt19937 rng(4);
    std::normal_distribution<float> gauss;
    const LinearImage reference = grey(32, 16, { 1 });
    for (const float shift : { 0.0f, 0.1f }) {
        std::vector<std::vector<double>> blocks;
        std::vector<double> means;
        for (int run = 0; run < 12; run++) {
            LinearImage image = reference;
            for (size_t i = 0; i < image.pixel_count(); i++)
                for (size_t c = 0; c < 3; c++)
                    image.rgb[3 * i + c] += (i % 32 < 16 ? shift : -shift) + (c == 0 ? 0.5f * gauss(rng) : 0);
            blocks.push_back(block_differences(reference, image, 16));
            means.push_back(measure_error(reference, image).mean_difference);
        }
        ASSERT_EQ(blocks[0].size(), 2u);
        const LocalBias bias = estimate_local_bias(blocks, std::vector<double>(2, 0.0));
        EXPECT_NEAR(bias.rms, double(shift), 0.01);
        EXPECT_EQ(bias.excess > 10, shift > 0) << bias.excess;
        const Estimate whole = estimate_bias(means, 0);
        EXPECT_LT(std::abs(whole.mean), 2 * whole.interval);
    }
}

TEST(BlockDifferences, CountsPartialBlocks)
{
    LinearImage image = grey(5, 3, { 1 });
    image.rgb[3 * 4] = image.rgb[3 * 4 + 1] = image.rgb[3 * 4 + 2] = 3; // the upper right pixel, in a block of 1 x 2
    const std::vector<double> blocks = block_differences(grey(5, 3, { 1 }), image, 2);
    ASSERT_EQ(blocks.size(), 6u);
    EXPECT_NEAR(blocks[2], 1, 1e-6);
    EXPECT_NEAR(blocks[0] + blocks[1] + blocks[3] + blocks[4] + blocks[5], 0, 1e-9);
}

TEST(Flicker, LeavesOutWhatTheSceneDoes)
{
    const LinearImage dark = grey(4, 4, { 1 }), bright = grey(4, 4, { 2 });
    const LinearImage frames[] = { dark, bright, dark };
    EXPECT_NEAR(measure_flicker(frames, frames), 0, 1e-9);
    const LinearImage still[] = { dark };
    EXPECT_NEAR(measure_flicker(still, frames), 1, 1e-6);
    const LinearImage level[] = { bright, bright, bright };
    EXPECT_NEAR(measure_flicker(still, level), 0, 1e-9); // wrong, but still
    EXPECT_EQ(measure_flicker(still, { frames, 1 }), 0);
    EXPECT_THROW(measure_flicker({ frames, 2 }, frames), std::invalid_argument);
}

} // namespace
} // namespace vkpt::tests
