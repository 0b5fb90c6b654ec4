// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/analysis/display.hpp"
#include "client/analysis/flip.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numeric>

namespace vkpt::tests {
namespace {

using namespace vkpt::analysis;

using Paint = std::function<float(int x, int y)>;
LinearImage paint(const Paint& value)
{
    LinearImage image = make_image(64, 48);
    image.is_display = true;
    for (size_t i = 0; i < image.pixel_count(); i++)
        for (size_t c = 0; c < 3; c++)
            image.rgb[3 * i + c] = value(int(i % 64), int(i / 64));
    return image;
}

LinearImage paint_colour(float r, float g, float b)
{
    LinearImage image = paint([](int, int) { return 0.0f; });
    for (size_t i = 0; i < image.pixel_count(); i++) {
        image.rgb[3 * i] = r;
        image.rgb[3 * i + 1] = g;
        image.rgb[3 * i + 2] = b;
    }
    return image;
}

double flip(const LinearImage& a, const LinearImage& b) { return mean_flip(measure_flip(a, b)); }

TEST(Flip, OfEqualPicturesIsZero)
{
    const LinearImage ramp = paint([](int x, int y) { return float(x + y) / 112; });
    EXPECT_EQ(flip(ramp, ramp), 0);
}

// Without edges only the colour counts. Green (L* 87.73, a* -86.18, b* 83.18) and blue (32.30, 79.19, -107.86) end the
// scale: with a* and b* times L* / 100, HyAB is 55.43 + hypot(101.2, 107.8) = 203.3, and 203.3^.7 = 41.28. Black and
// white are 100 apart: 100^.7 = 25.12 lies above the knee at .4 * 41.28 = 16.51, so .95 + .05 * (25.12 - 16.51) / 24.77
// = .9674.
TEST(Flip, OfFlatColoursFollowsTheFormula)
{
    EXPECT_NEAR(flip(paint_colour(0, 0, 0), paint_colour(1, 1, 1)), 0.9674, 3e-4);
    EXPECT_NEAR(flip(paint_colour(0, 1, 0), paint_colour(0, 0, 1)), 1, 1e-3);
    // L* = 50: 50^.7 = 15.46, .95 * 15.46 / 16.51 = .8896.
    EXPECT_NEAR(flip(paint_colour(0.18419f, 0.18419f, 0.18419f), paint_colour(1, 1, 1)), 0.8896, 5e-4);
}

TEST(Flip, IsSymmetricAndGrowsWithTheDifference)
{
    const LinearImage a = paint([](int x, int) { return float(x) / 64; });
    double before = 0;
    for (const float shift : { 0.02f, 0.1f, 0.3f }) {
        const LinearImage b = paint([&](int x, int) { return float(x) / 64 * (1 - shift); });
        const double difference = flip(a, b);
        EXPECT_NEAR(difference, flip(b, a), 1e-6);
        EXPECT_GT(difference, before);
        before = difference;
    }
}

// The eye does not resolve what is finer than about a sixtieth of a degree.
TEST(Flip, ForgivesFinePatternsMoreThanCoarseOnes)
{
    const auto stripes = [](int period, float sign) {
        return paint([=](int x, int) { return 0.5f + sign * 0.15f * (x / period % 2 ? 1.0f : -1.0f); });
    };
    const double fine = flip(stripes(1, 1), stripes(1, -1)), coarse = flip(stripes(16, 1), stripes(16, -1));
    EXPECT_LT(fine, 0.6 * coarse);
    // From farther away, less is seen.
    EXPECT_LT(mean_flip(measure_flip(stripes(2, 1), stripes(2, -1), 200)),
        mean_flip(measure_flip(stripes(2, 1), stripes(2, -1), 30)));
}

// The same colour difference counts more where it makes an edge or a point.
TEST(Flip, RaisesEdgesAndPoints)
{
    const LinearImage flat = paint([](int, int) { return 0.3f; });
    const LinearImage dot
        = paint([](int x, int y) { return std::hypot(float(x - 32), float(y - 24)) < 3 ? 0.5f : 0.3f; });
    const std::vector<float> map = measure_flip(flat, dot);
    const float at_dot = map[24 * 64 + 32], far_away = map[2 * 64 + 2];
    EXPECT_EQ(far_away, 0);
    const std::vector<float> even = measure_flip(flat, paint([](int, int) { return 0.5f; }));
    EXPECT_GT(at_dot, 1.1f * even[24 * 64 + 32]);
    for (const float value : map)
        EXPECT_TRUE(value >= 0 && value <= 1);
}

TEST(Flip, RefusesDifferentSizes)
{
    EXPECT_THROW(measure_flip(make_image(3, 4), make_image(4, 3)), std::invalid_argument);
}

TEST(Display, KeepsItsPromises)
{
    for (const float value : { 0.0f, 0.001f, 0.2f, 1.0f })
        EXPECT_NEAR(decode_srgb(encode_srgb(value)), value, 1e-6);
    LinearImage radiance = paint([](int x, int) { return 7 * std::exp(float(x) / 16); });
    radiance.is_display = false;
    const float exposure = choose_exposure(radiance);
    LinearImage exposed = radiance;
    scale_image(exposed, exposure);
    double logs = 0;
    for (const float value : luminances(exposed))
        logs += std::log(double(value)) / double(exposed.pixel_count());
    EXPECT_NEAR(std::exp(logs), 0.18, 2e-3);
    const LinearImage shown = map_to_display(radiance, exposure);
    for (size_t i = 1; i < 64; i++)
        EXPECT_GE(shown.rgb[3 * i], shown.rgb[3 * i - 3]);
    EXPECT_EQ(map_to_display(shown, 100).rgb, shown.rgb);
}

} // namespace
} // namespace vkpt::tests
