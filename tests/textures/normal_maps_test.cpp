// SPDX-License-Identifier: GPL-2.0-or-later
// Normal maps as shaders read them, level by level.
#include "ref_vkpt/scene/normal_maps.hpp"
#include "tests/formats/file_budget.hpp"
#include "tests/formats/picture_bombs.hpp"
#include "tests/textures/make_plain.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace vkpt {
namespace {

uint8_t byte_of(double component) { return uint8_t(std::lround(component * 127 + 128)); }

formats::Rgba8 texel_of(double x, double y, double z, uint8_t alpha = 255)
{
    return { byte_of(x), byte_of(y), byte_of(z), alpha };
}

double decode(uint8_t byte) { return (byte - 128) / 127.0; }

TEST(NormalMaps, HaveLevelsDownToOneTexel)
{
    const std::vector<formats::Image> levels = make_normal_levels(make_plain(12, 5, texel_of(0, 0, 1)));
    ASSERT_EQ(levels.size(), 4u);
    EXPECT_EQ(levels[1].width, 6);
    EXPECT_EQ(levels[1].height, 2);
    EXPECT_EQ(levels[3].width, 1);
    EXPECT_EQ(levels[3].height, 1);
    EXPECT_EQ(make_normal_levels(make_plain(1, 1, {})).size(), 1u);
}

TEST(NormalMaps, FlatStaysFlatToTheBit)
{
    for (const formats::Image& level : make_normal_levels(make_plain(16, 16, { 128, 128, 255, 255 })))
        for (const formats::Rgba8& texel : level.pixels)
            EXPECT_EQ(texel, (formats::Rgba8 { 128, 128, 0, 255 }));
}

TEST(NormalMaps, KeepDirectionsWhateverTheirLength)
{
    for (const double length : { 0.3, 1.0 }) {
        const formats::Image level
            = make_normal_levels(make_plain(2, 2, texel_of(0.6 * length, -0.48 * length, 0.64 * length, 77)))[0];
        EXPECT_NEAR(decode(level.pixels[0].r), 0.6, 0.02) << length;
        EXPECT_NEAR(decode(level.pixels[0].g), -0.48, 0.02) << length;
        EXPECT_EQ(level.pixels[0].b, 0) << length;
        EXPECT_EQ(level.pixels[0].a, 77) << length;
    }
}

// Two directions, 37 degrees to either side: their mean is 0.8 long.
TEST(NormalMaps, AverageIntoVariance)
{
    formats::Image image = make_plain(2, 2, texel_of(0.6, 0, 0.8, 100));
    image.pixels[1] = image.pixels[3] = texel_of(-0.6, 0, 0.8, 200);
    const formats::Rgba8 mean = make_normal_levels(image)[1].pixels[0];
    EXPECT_EQ(mean.r, 128);
    EXPECT_EQ(mean.g, 128);
    EXPECT_NEAR(std::pow(mean.b / 255.0, 2), 0.2 / 0.8, 0.01);
    EXPECT_EQ(mean.a, 150);
}

TEST(NormalMaps, WhatPointsInwardsOrNowhereIsFlat)
{
    for (const formats::Rgba8 bad : { texel_of(0.6, 0, -0.8), texel_of(0, 0, -1), formats::Rgba8 { 128, 128, 128, 255 },
             formats::Rgba8 { 0, 0, 0, 0 } }) {
        const formats::Rgba8 level = make_normal_levels(make_plain(2, 2, bad))[0].pixels[0];
        EXPECT_EQ(level.r, 128);
        EXPECT_EQ(level.g, 128);
    }
}

TEST(NormalMaps, OfSmallFilesAreCheap)
{
    const std::vector<std::byte> file
        = samples::make_black_png({ .width = 4096, .height = 4096, .bits = 1, .colour_type = 0 });
    ASSERT_LT(file.size(), tests::small_file_bytes);
    const tests::Cost cost = tests::expect_within_budget(
        "a normal map of 4096 x 4096", [&] { make_normal_levels(formats::read_common_image(file, "large_n.png")); });
    EXPECT_EQ(cost.outcome, "read");
}

} // namespace
} // namespace vkpt
