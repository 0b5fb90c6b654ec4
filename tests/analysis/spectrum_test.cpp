// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/analysis/spectrum.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace vkpt::tests {
namespace {

using namespace vkpt::analysis;

TEST(Spectrum, TellsWhiteFromSmoothAndRough)
{
    std::mt19937 rng(1);
    std::normal_distribution<double> gauss;
    constexpr size_t side = 128;
    std::vector<double> white(side * side), smooth(side * side), rough(side * side);
    for (double& value : white)
        value = 3 * gauss(rng);
    for (size_t i = 0; i < white.size(); i++) {
        smooth[i] = std::sin(double(i % side) * 0.1);
        rough[i] = (i % side + i / side) % 2 ? 1 : -1;
    }
    const Spectrum spectrum = measure_spectrum(white, side);
    EXPECT_NEAR(spectrum.low_to_high(), 1, 0.15);
    EXPECT_NEAR(spectrum.high, 9, 0.5);
    EXPECT_GT(measure_spectrum(smooth, side).low_to_high(), 20);
    EXPECT_LT(measure_spectrum(rough, side).low_to_high(), 0.01);
}

// High-pass noise on the left, a hundred times as much white noise on the right: tiles count alike.
TEST(TiledSpectrum, DoesNotListenToTheLoudestTileOnly)
{
    std::mt19937 rng(2);
    std::normal_distribution<double> gauss;
    constexpr size_t width = 2 * spectrum_tile + 5, height = spectrum_tile + 9;
    std::vector<std::vector<double>> pictures;
    for (int picture = 0; picture < 16; picture++) {
        std::vector<double> values(width * height);
        for (size_t i = 0; i < values.size(); i++) {
            const size_t x = i % width, y = i / width;
            values[i] = x < spectrum_tile ? ((x + y) % 2 ? 1 : -1) : 100 * gauss(rng);
        }
        pictures.push_back(values);
    }
    const double ratio = measure_tiled_spectrum(pictures, width, height).low_to_high();
    EXPECT_NEAR(ratio, 0.5, 0.06);
}

TEST(TiledSpectrum, IsEmptyWithoutAnythingToMeasure)
{
    EXPECT_TRUE(measure_tiled_spectrum({ std::vector<double>(64 * 64, 3.0) }, 64, 64).power.empty());
    EXPECT_TRUE(measure_tiled_spectrum({ std::vector<double>(8 * 8, 3.0) }, 8, 8).power.empty());
    EXPECT_THROW(measure_tiled_spectrum({ std::vector<double>(5) }, 64, 64), std::invalid_argument);
}

} // namespace
} // namespace vkpt::tests
