// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/engine/picture_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vkpt::tests {

namespace {

formats::Image make_ramp(int width, int height, double noise)
{
    std::mt19937 random(7);
    std::normal_distribution<double> normal(0, noise);
    formats::Image picture { width, height, {} };
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const double value = 0.25 + 0.5 * double(x) / double(width) + normal(random);
            const auto byte = uint8_t(std::lround(255 * value));
            picture.pixels.push_back({ byte, byte, byte, 255 });
        }
    return picture;
}

} // namespace

TEST(PictureStatistics, FindsTheNoiseOnARamp)
{
    for (const double noise : { 0.02, 0.04 }) {
        const PictureStatistics statistics = measure_picture(make_ramp(320, 200, noise));
        EXPECT_NEAR(statistics.noise, noise, 0.1 * noise);
        EXPECT_NEAR(statistics.mean, 0.5, 0.01);
        EXPECT_EQ(statistics.black, 0);
    }
}

TEST(PictureStatistics, ASmoothRampHasHardlyAny) { EXPECT_LT(measure_picture(make_ramp(320, 200, 0)).noise, 0.002); }

TEST(PictureStatistics, CountsBlackPixels)
{
    formats::Image picture { 4, 4, std::vector<formats::Rgba8>(16) };
    picture.pixels[3] = { 1, 0, 0, 255 };
    EXPECT_DOUBLE_EQ(measure_picture(picture).black, 15.0 / 16);
}

} // namespace vkpt::tests
