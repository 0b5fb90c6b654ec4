// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/image.hpp"
#include "tests/formats/samples.hpp"

#include <cstring>
#include <gtest/gtest.h>

namespace formats {

namespace {

using namespace vkpt::samples;

TEST(Pcx, RoundTrip)
{
    for (const auto& [width, height] : { std::pair(320, 240), std::pair(7, 5), std::pair(1, 1), std::pair(129, 3) }) {
        const IndexedImage image = make_indexed_image(width, height);
        const IndexedImage again = read_pcx(write_pcx(image), "sample.pcx");
        EXPECT_EQ(again.width, width);
        EXPECT_EQ(again.height, height);
        EXPECT_EQ(again.pixels, image.pixels);
        EXPECT_EQ(again.palette, image.palette);
        EXPECT_EQ(read_pcx_palette(write_pcx(image), "sample.pcx"), image.palette);
    }
}

TEST(Pcx, SkipsThePaddingOfLines)
{
    IndexedImage wide { 4, 2, { 1, 2, 3, 99, 4, 5, 6, 99 }, {} };
    auto file = write_pcx(wide);
    file[8] = std::byte { 2 }; // x_max: three columns, while a line keeps its four bytes
    const IndexedImage image = read_pcx(file, "padded.pcx");
    EXPECT_EQ(image.width, 3);
    EXPECT_EQ(image.pixels, (std::vector<uint8_t> { 1, 2, 3, 4, 5, 6 }));
}

TEST(Pcx, TransparentPixelsTakeANeighboursColour)
{
    IndexedImage image { 3, 1, { 5, 255, 255 }, make_indexed_image(1, 1).palette };
    const Image picture = read_image(write_pcx(image), "pics/X.PCX", {});
    const Rgba8 solid = image.palette[5];
    EXPECT_EQ(picture.at(0, 0), solid);
    EXPECT_EQ(picture.at(1, 0), (Rgba8 { solid.r, solid.g, solid.b, 0 }));
    EXPECT_EQ(picture.at(2, 0), (Rgba8 { 0, 0, 0, 0 }));
}

// 24 bits a pixel: a plane for each colour in every line, runs that go on from one into the next, no palette.
TEST(Pcx, ReadsTrueColour)
{
    std::vector<std::byte> file = write_pcx(make_indexed_image(3, 2));
    file.resize(128);
    file[65] = std::byte { 3 };
    file[66] = std::byte { 4 }; // of a plane's line, of which a picture uses three
    for (const int byte : { 10, 11, 12, 0, 20, 21, 22, 0, 0xc1, 200, 31, 32, 0, 0xc8, 7, 1, 2, 3, 0 })
        file.push_back(std::byte(byte));
    const Image image = read_image(file, "skin.pcx", {});
    ASSERT_EQ(image.width, 3);
    ASSERT_EQ(image.height, 2);
    EXPECT_EQ(image.at(0, 0), (Rgba8 { 10, 20, 200, 255 }));
    EXPECT_EQ(image.at(2, 0), (Rgba8 { 12, 22, 32, 255 }));
    EXPECT_EQ(image.at(0, 1), (Rgba8 { 7, 7, 1, 255 }));
    EXPECT_EQ(image.at(2, 1), (Rgba8 { 7, 7, 3, 255 }));
    file.resize(file.size() - 5);
    EXPECT_THROW(read_image(file, "skin.pcx", {}), FormatError);
    EXPECT_THROW(read_pcx(file, "skin.pcx"), FormatError) << "it has no palette";
}

TEST(Pcx, RefusesOtherKinds)
{
    auto file = write_pcx(make_indexed_image(8, 8));
    for (const auto& [offset, value] : { std::pair(0, 0), std::pair(3, 4), std::pair(65, 3), std::pair(8, 0xff) }) {
        auto broken = file;
        broken[size_t(offset)] = std::byte(value);
        EXPECT_THROW(read_pcx(broken, "broken.pcx"), FormatError) << offset;
    }
    file.resize(file.size() - 1);
    EXPECT_THROW(read_pcx_palette(file, "short.pcx"), FormatError);
}

TEST(Wal, RoundTripWithMips)
{
    const IndexedImage image = make_indexed_image(32, 16);
    const WallInfo info { "e1/floor", "e1/floor2", 0, 0, 0x1, 0x2, -300 };
    const auto file = write_wal(image, info);
    EXPECT_EQ(file.size(), 100u + 32 * 16 + 16 * 8 + 8 * 4 + 4 * 2);
    const WallInfo again = read_wal_info(file, "floor.wal");
    EXPECT_EQ(again.name, info.name);
    EXPECT_EQ(again.next_animation, info.next_animation);
    EXPECT_EQ(again.width, 32);
    EXPECT_EQ(again.height, 16);
    EXPECT_EQ(again.flags, info.flags);
    EXPECT_EQ(again.contents, info.contents);
    EXPECT_EQ(again.value, info.value);
    const Image picture = read_image(file, "floor.wal", image.palette);
    EXPECT_EQ(picture.pixels, apply_palette(image, image.palette, false).pixels);
}

TEST(Wal, MipsAverage)
{
    IndexedImage checker { 16, 16, {}, {} };
    for (int i = 0; i < 256; i++)
        checker.palette[size_t(i)] = { uint8_t(i), uint8_t(i), uint8_t(i), 255 };
    for (int i = 0; i < 256; i++)
        checker.pixels.push_back((i + i / 16) % 2 ? 200 : 100);
    const auto file = write_wal(checker, {});
    EXPECT_EQ(file[100 + 256], std::byte { 150 });
    EXPECT_EQ(file.back(), std::byte { 150 });
}

TEST(M8, Reads)
{
    const auto file = make_m8();
    EXPECT_EQ(read_m8_info(file, "m8").name, "walls/m8");
    EXPECT_EQ(read_m8_info(file, "m8").next_animation, "walls/m8_next");
    EXPECT_EQ(read_m8_info(file, "m8").flags, 1u);
    EXPECT_EQ(read_m8_info(file, "m8").contents, 2u);
    EXPECT_EQ(read_m8_info(file, "m8").value, 3);
    const Image image = read_image(file, "a.m8", {});
    ASSERT_EQ(image.pixels.size(), 32u);
    EXPECT_EQ(image.at(1, 1), (Rgba8 { 72, 36, 18, 255 }));
}

TEST(M32, Reads)
{
    const auto file = make_m32();
    EXPECT_EQ(read_m32_info(file, "m32").next_animation, "walls/m32_next");
    EXPECT_EQ(read_m32_info(file, "m32").flags, 1u);
    EXPECT_EQ(read_m32_info(file, "m32").contents, 2u);
    EXPECT_EQ(read_m32_info(file, "m32").value, 3);
    const Image image = read_image(file, "a.m32", {});
    ASSERT_EQ(image.pixels.size(), 32u);
    EXPECT_EQ(image.at(1, 1), (Rgba8 { 9, 18, 27, 36 }));
}

TEST(CommonImages, PngAndTgaRoundTrip)
{
    const Image image = make_image(31, 17);
    for (const auto& file : { write_png(image), write_tga(image) }) {
        const Image again = read_common_image(file, "picture");
        EXPECT_EQ(again.width, 31);
        EXPECT_EQ(again.height, 17);
        EXPECT_EQ(again.pixels, image.pixels);
    }
}

TEST(CommonImages, ReadsJpg)
{
    const Image image = make_image(16, 16), again = read_image(make_jpg(16, 16), "wall.jpg", {});
    ASSERT_EQ(again.pixels.size(), image.pixels.size());
    for (size_t i = 0; i < image.pixels.size(); i++) {
        EXPECT_NEAR(again.pixels[i].r, image.pixels[i].r, 24) << i;
        EXPECT_NEAR(again.pixels[i].g, image.pixels[i].g, 24) << i;
        EXPECT_EQ(again.pixels[i].a, 255);
    }
}

TEST(CommonImages, RefusesJpgWithOverlongHuffmanTables)
{
    auto file = make_jpg(16, 16);
    size_t tables = 0;
    while (file[tables] != std::byte { 0xff } || file[tables + 1] != std::byte { 0xc4 })
        tables++;
    for (size_t count = 0; count < 16; count++)
        file[tables + 5 + count] = std::byte { count < 15 ? uint8_t(17) : uint8_t(2) }; // 257 codes
    EXPECT_THROW(read_common_image(file, "long.jpg"), FormatError);
}

TEST(CommonImages, ReadsPackedTgaBottomUp)
{
    const Image image = read_common_image(make_packed_tga(), "packed.tga");
    ASSERT_EQ(image.pixels.size(), 15u);
    EXPECT_EQ(image.at(0, 2), (Rgba8 { 30, 20, 10, 255 }));
    EXPECT_EQ(image.at(1, 1), (Rgba8 { 30, 20, 10, 255 }));
    EXPECT_EQ(image.at(2, 1), (Rgba8 { 200, 100, 0, 255 }));
    EXPECT_EQ(image.at(4, 0), (Rgba8 { 207, 107, 7, 255 }));
}

// Bits 4 and 5 of the descriptor say at which corner the pixels begin.
TEST(CommonImages, TurnsTgaFromEveryCorner)
{
    const Image image = make_image(5, 3);
    for (const bool right : { false, true })
        for (const bool top : { false, true }) {
            auto file = write_tga(image);
            file[17] = std::byte(8 | (right ? 0x10 : 0) | (top ? 0x20 : 0));
            const Image turned = read_common_image(file, "turned.tga");
            for (int y = 0; y < 3; y++)
                for (int x = 0; x < 5; x++)
                    EXPECT_EQ(turned.at(x, y), image.at(right ? 4 - x : x, top ? y : 2 - y)) << x << " " << y;
        }
}

TEST(CommonImages, RefusesAPictureThatTheFileCannotHold)
{
    auto png = write_png(make_image(8, 8));
    png[18] = png[22] = std::byte { 0x40 }; // 16384 + 8 is too large, 16384 is not
    png[19] = png[23] = std::byte { 0 };
    EXPECT_THROW(read_common_image(png, "huge.png"), FormatError);
    auto tga = write_tga(make_image(8, 8));
    tga[13] = tga[15] = std::byte { 0x3f };
    EXPECT_THROW(read_common_image(tga, "huge.tga"), FormatError);
    EXPECT_THROW(read_common_image({}, "empty"), FormatError);
}

TEST(Pfm, LowestRowFirst)
{
    const std::array<float, 12> rgb { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12 };
    const auto file = write_pfm(2, 2, rgb);
    const std::string header = "PF\n2 2\n-1.0\n";
    ASSERT_EQ(file.size(), header.size() + sizeof(rgb));
    EXPECT_EQ(std::memcmp(file.data(), header.data(), header.size()), 0);
    EXPECT_EQ(std::memcmp(file.data() + header.size(), &rgb[6], 24), 0);
    EXPECT_EQ(std::memcmp(file.data() + header.size() + 24, &rgb[0], 24), 0);
    EXPECT_THROW(write_pfm(3, 2, rgb), std::invalid_argument);
}

} // namespace

} // namespace formats
