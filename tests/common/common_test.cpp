// SPDX-License-Identifier: GPL-2.0-or-later
#include "common/colour.hpp"
#include "common/parallel.hpp"
#include "common/quantile.hpp"

#include <atomic>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <stdexcept>
#include <vector>

namespace vkpt::tests {
namespace {

// Values of the standard's own table, to its digits.
TEST(Colour, SrgbCurveHasKnownValues)
{
    EXPECT_EQ(decode_srgb(0.0), 0);
    EXPECT_DOUBLE_EQ(decode_srgb(1.0), 1);
    EXPECT_NEAR(decode_srgb(10 / 255.0), 0.0030353, 5e-8); // on the line
    EXPECT_NEAR(decode_srgb(128 / 255.0), 0.2158605, 5e-8);
    EXPECT_NEAR(encode_srgb(0.18), 0.4613561, 5e-8);
    for (int byte = 0; byte < 256; byte++) {
        EXPECT_NEAR(encode_srgb(decode_srgb(byte / 255.0)), byte / 255.0, 1e-7);
        EXPECT_NEAR(decode_srgb(float(byte) / 255), decode_srgb(byte / 255.0), 1e-6);
    }
}

TEST(Colour, LuminanceWeighsByRec709)
{
    const float rgb[] = { 0, 0, 1 };
    EXPECT_FLOAT_EQ(luminance(rgb), 0.0722f);
    EXPECT_DOUBLE_EQ(luminance(glm::dvec3(1, 0, 0)), 0.2126);
    EXPECT_FLOAT_EQ(luminance(glm::vec3(0, 1, 0)), 0.7152f);
    EXPECT_FLOAT_EQ(luminance(glm::vec3(2)), 2);
}

TEST(Quantile, IsOfTheNearestRank)
{
    const std::vector<float> values { 5, 1, 4, 2, 3 };
    EXPECT_EQ(find_median(values), 3);
    EXPECT_EQ(find_quantile(values, 0.05), 1);
    EXPECT_EQ(find_quantile(values, 0.95), 5);
    EXPECT_EQ(find_quantile(values, 0.4), 2);
    EXPECT_EQ(find_median(std::vector<double> { 1, 2 }), 1);
    EXPECT_EQ(find_median(std::vector<float> {}), 0);
}

TEST(Parallel, DoesEachPieceOnce)
{
    for (const unsigned threads : { 1u, 4u }) {
        std::vector<int> done(1000, 0);
        parallel_for(done.size(), threads, [&](size_t i) { done[i]++; });
        EXPECT_EQ(done, std::vector<int>(1000, 1));
    }
}

TEST(Parallel, PassesAnExceptionOn)
{
    std::atomic<size_t> done = 0;
    EXPECT_THROW(parallel_for(100'000, 3,
                     [&](size_t) {
                         done++;
                         throw std::runtime_error("no");
                     }),
        std::runtime_error);
    EXPECT_LE(done, 3u) << "each thread ends at its first";
}

} // namespace
} // namespace vkpt::tests
