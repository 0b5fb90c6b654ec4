// SPDX-License-Identifier: GPL-2.0-or-later
#include "glsl_libraries.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace vkpt::test {
namespace {

using namespace glsl;

constexpr int bin_count = 64;

// Five standard deviations above the mean of a chi-square distribution.
double highest_plausible_chi_square(double freedom) { return freedom + 5 * std::sqrt(2 * freedom); }

double chi_square_of(const std::vector<float>& numbers)
{
    std::vector<double> counts(bin_count, 0);
    for (const float x : numbers)
        counts[size_t(x * bin_count)]++;
    const double expected = double(numbers.size()) / bin_count;
    double sum = 0;
    for (const double count : counts)
        sum += (count - expected) * (count - expected) / expected;
    return sum;
}

double correlation_of(const std::vector<float>& a, const std::vector<float>& b)
{
    double sum = 0;
    for (size_t i = 0; i < a.size(); i++)
        sum += (a[i] - 0.5) * (b[i] - 0.5) * 12;
    return sum / double(a.size());
}

// One number per pixel of a picture.
std::vector<float> picture_of(uint frame, uint seed, uint dimension)
{
    std::vector<float> numbers;
    for (uint y = 0; y < 128; y++)
        for (uint x = 0; x < 128; x++)
            numbers.push_back(white_dimension(uvec2(x, y), frame, seed, dimension));
    return numbers;
}

TEST(Random, LiesInHalfOpenUnitInterval)
{
    EXPECT_EQ(uint_to_unit_float(0), 0.0f);
    EXPECT_LT(uint_to_unit_float(0xffffffffu), 1.0f);
    EXPECT_EQ(uint_to_unit_float(0xffffffffu), 1.0f - 5.9604644775390625e-8f);
}

TEST(Random, IsUniformOverPixelsFramesAndDimensions)
{
    for (uint k = 0; k < 8; k++) {
        EXPECT_LT(chi_square_of(picture_of(k, 1, 0)), highest_plausible_chi_square(bin_count - 1)) << "frame " << k;
        EXPECT_LT(chi_square_of(picture_of(0, 1, k)), highest_plausible_chi_square(bin_count - 1)) << "dimension " << k;
    }
    std::vector<float> path;
    Random random = make_random(uvec2(5, 7), 3, 1);
    for (int i = 0; i < 16384; i++)
        path.push_back(next_float(random));
    EXPECT_LT(chi_square_of(path), highest_plausible_chi_square(bin_count - 1));
}

TEST(Random, NeighboursAreUncorrelated)
{
    const std::vector<float> here = picture_of(10, 1, 3);
    std::vector<float> shifted(here.begin() + 1, here.end());
    shifted.push_back(here.front());
    const double plausible = 5 / std::sqrt(double(here.size()));
    EXPECT_LT(std::abs(correlation_of(here, shifted)), plausible);
    EXPECT_LT(std::abs(correlation_of(here, picture_of(11, 1, 3))), plausible);
    EXPECT_LT(std::abs(correlation_of(here, picture_of(10, 2, 3))), plausible);
    EXPECT_LT(std::abs(correlation_of(here, picture_of(10, 1, 4))), plausible);
}

TEST(Random, CanBeReplayed)
{
    Random first = make_random(uvec2(100, 200), 42, 9), again = make_random(uvec2(100, 200), 42, 9);
    for (int i = 0; i < 100; i++)
        ASSERT_EQ(next_float(first), next_float(again));
    Random second_bounce = random_for_bounce(first, 2);
    EXPECT_EQ(next_float(second_bounce), white_dimension(uvec2(100, 200), 42, 9, 2 * random_dimensions_per_bounce));
    Random other = random_stream(make_random(uvec2(100, 200), 42, 9), 1);
    EXPECT_NE(next_float(other), white_dimension(uvec2(100, 200), 42, 9, 0));
}

} // namespace
} // namespace vkpt::test
