// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/scene/bright_parts.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <utility>
#include <vector>

namespace vkpt {
namespace {

constexpr formats::Rgba8 dark { 20, 22, 25, 255 }, lamp { 255, 240, 200, 255 }, red { 255, 40, 30, 255 };

formats::Image panel(int width, int height)
{
    return { width, height, std::vector<formats::Rgba8>(size_t(width * height), dark) };
}

void paint(formats::Image& image, int x0, int y0, int x1, int y1, formats::Rgba8 colour)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            image.pixels[size_t(y * image.width + x)] = colour;
}

TEST(BrightParts, AreTheLampsOfAPanel)
{
    formats::Image image = panel(64, 128);
    paint(image, 8, 16, 24, 48, lamp);
    paint(image, 40, 80, 56, 96, red);
    std::vector<BrightPart> parts = find_bright_parts(image);
    ASSERT_EQ(parts.size(), 1u); // the red one is not a third as bright
    paint(image, 40, 80, 56, 96, lamp);
    parts = find_bright_parts(image);
    ASSERT_EQ(parts.size(), 2u);
    std::ranges::sort(parts, {}, [](const BrightPart& part) { return part.mins.y; });
    EXPECT_EQ(parts[0].mins, glm::vec2(8.0f / 64, 16.0f / 128));
    EXPECT_EQ(parts[0].maxs, glm::vec2(24.0f / 64, 48.0f / 128));
    EXPECT_EQ(parts[1].mins, glm::vec2(40.0f / 64, 80.0f / 128));
    EXPECT_EQ(parts[1].maxs, glm::vec2(56.0f / 64, 96.0f / 128));
    EXPECT_NEAR(parts[0].average.x, 1, 1e-4f);
    EXPECT_NEAR(parts[0].average.z, 0.577f, 1e-2f); // 200 of 255, linear
}

// What is around a ring includes what is in it.
TEST(BrightParts, DoNotOverlap)
{
    formats::Image image = panel(64, 64);
    paint(image, 10, 10, 40, 12, lamp);
    paint(image, 10, 10, 12, 40, lamp);
    paint(image, 24, 24, 32, 32, lamp);
    const std::vector<BrightPart> parts = find_bright_parts(image);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].mins, glm::vec2(10.0f / 64));
    EXPECT_EQ(parts[0].maxs, glm::vec2(40.0f / 64));
}

TEST(BrightParts, AreNoneWhereAllOfItShines)
{
    EXPECT_TRUE(find_bright_parts(panel(64, 64)).empty());
    formats::Image image = panel(64, 64);
    paint(image, 4, 4, 60, 60, lamp); // a frame around it
    EXPECT_TRUE(find_bright_parts(image).empty());
    image = panel(64, 64);
    for (int i = 0; i < 8; i++)
        paint(image, i * 8, i * 8, i * 8 + 4, i * 8 + 4, lamp); // many
    EXPECT_TRUE(find_bright_parts(image).empty());
    // One bright dot, but most of the light comes from the rest.
    image = { 64, 64, std::vector<formats::Rgba8>(64 * 64, formats::Rgba8 { 120, 120, 120, 255 }) };
    paint(image, 30, 30, 34, 34, lamp);
    EXPECT_TRUE(find_bright_parts(image).empty());
}

TEST(BrightParts, OfAnyPicture)
{
    EXPECT_TRUE(find_bright_parts({}).empty());
    EXPECT_TRUE(find_bright_parts(panel(1, 300)).empty());
    EXPECT_TRUE(
        find_bright_parts({ 16, 16, std::vector<formats::Rgba8>(256, formats::Rgba8 { 0, 0, 0, 255 }) }).empty());
    EXPECT_TRUE(
        find_bright_parts({ 16, 16, std::vector<formats::Rgba8>(256, formats::Rgba8 { 255, 255, 255, 0 }) }).empty());
    formats::Image image = panel(37, 91); // cells of different sizes
    paint(image, 10, 20, 20, 40, lamp);
    const std::vector<BrightPart> parts = find_bright_parts(image);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_NEAR(parts[0].mins.x, 10.0f / 37, 1.0f / 32);
    EXPECT_NEAR(parts[0].maxs.y, 40.0f / 91, 1.0f / 32);
}

TEST(BrightTexels, AreKeptAsTheyAre)
{
    formats::Image image { 4, 1, { { 215, 0, 0, 255 }, { 214, 214, 214, 9 }, { 0, 10, 220, 0 }, { 0, 0, 0, 255 } } };
    image = keep_bright_texels(std::move(image), 215);
    const std::vector<formats::Rgba8> wanted { { 215, 0, 0, 255 }, { 0, 0, 0, 9 }, { 0, 10, 220, 0 },
        { 0, 0, 0, 255 } };
    EXPECT_TRUE(image.pixels == wanted);
}

} // namespace
} // namespace vkpt
