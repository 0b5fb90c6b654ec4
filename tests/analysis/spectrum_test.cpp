// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/analysis/spectrum.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
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

// One wave has all its power at its own frequency, whichever way it runs, and half a picture of side^2 / 2 pixels'
// worth at each of the two places that are it.
TEST(Spectrum, AWaveStandsInItsOwnBand)
{
    constexpr size_t side = 64;
    for (const auto& [across, down] :
        { std::pair { 3, 0 }, { 0, 5 }, { 7, 2 }, { 4, 6 }, { 8, 0 }, { 0, 9 }, { 12, 5 }, { 21, 17 }, { 31, 0 } }) {
        SCOPED_TRACE(testing::Message() << across << " " << down);
        std::vector<double> wave(side * side);
        for (size_t i = 0; i < wave.size(); i++)
            wave[i] = std::cos(
                2 * std::numbers::pi * double(size_t(across) * (i % side) + size_t(down) * (i / side)) / double(side));
        const Spectrum spectrum = measure_spectrum(wave, side);
        const double frequency = std::hypot(across, down) / double(side);
        EXPECT_NEAR(frequency < 0.125 ? spectrum.high : spectrum.low, 0, 1e-9)
            << "an eighth of a cycle per pixel divides";
        EXPECT_GT(frequency < 0.125 ? spectrum.low : spectrum.high, 0.1);
        const auto own = size_t(frequency * 2 * double(spectrum.power.size()));
        for (size_t band = 0; band < spectrum.power.size(); band++)
            if (band == own)
                EXPECT_GT(spectrum.power[band], 1) << band;
            else
                EXPECT_NEAR(spectrum.power[band], 0, 1e-9) << band;
    }
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
