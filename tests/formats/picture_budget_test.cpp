// SPDX-License-Identifier: GPL-2.0-or-later
// Small pictures that ask for gigabytes or minutes, or that write past the decoder's tables.
#include "formats/byte_writer.hpp"
#include "formats/image.hpp"
#include "tests/formats/file_budget.hpp"
#include "tests/formats/picture_bombs.hpp"
#include "tests/formats/samples.hpp"

#include <cstdlib>
#include <gtest/gtest.h>

namespace formats {

namespace {

using namespace vkpt::samples;
using vkpt::tests::Cost;
using vkpt::tests::expect_within_budget;

Cost expect_cheap(const std::vector<std::byte>& file, const std::string& name)
{
    EXPECT_LT(file.size(), vkpt::tests::small_file_bytes) << name;
    return expect_within_budget(name, [&] { read_image(file, name, {}); });
}

void expect_refused(const std::vector<std::byte>& file, const std::string& name, const std::string& reason)
{
    const Cost cost = expect_cheap(file, name);
    EXPECT_TRUE(cost.refused()) << name;
    EXPECT_NE(cost.outcome.find(name), std::string::npos) << cost.outcome;
    EXPECT_NE(cost.outcome.find(reason), std::string::npos) << cost.outcome;
}

std::vector<std::byte> bytes_of(const std::vector<int>& numbers)
{
    ByteWriter writer;
    for (const int number : numbers)
        writer.write(uint8_t(number));
    return writer.take();
}

TEST(FileBudget, SeesMemoryTimeAndFaults)
{
    // Every byte is written, as only touched memory counts.
    const Cost memory = vkpt::tests::measure_cost([] { (void)std::vector<char>(size_t(600) << 20, 'x').at(5); });
    EXPECT_TRUE(memory.ended) << memory.outcome;
    EXPECT_GT(memory.peak_bytes, vkpt::tests::budget_bytes);
    const Cost time = vkpt::tests::measure_cost([] {
        for (const clock_t start = clock(); clock() - start < CLOCKS_PER_SEC / 2;) { }
    });
    EXPECT_GT(time.cpu_seconds, 0.4);
    EXPECT_LT(time.cpu_seconds, 2);
    EXPECT_LT(time.peak_bytes, size_t(50) << 20);
    EXPECT_FALSE(vkpt::tests::measure_cost([] { std::abort(); }).ended);
    EXPECT_FALSE(vkpt::tests::measure_cost([] { EXPECT_TRUE(false) << "is meant to fail here"; }).ended);
    EXPECT_EQ(vkpt::tests::measure_cost([] { throw std::runtime_error("why"); }).outcome, "refused: why");
}

TEST(PictureBudget, HugePicturesInSmallFilesAreRefused)
{
    expect_refused(
        make_black_png({ .width = 16384, .height = 16384, .bits = 1, .colour_type = 0 }), "grey.png", "16384");
    expect_refused(make_black_png({ .width = 8192, .height = 8192 }), "rgba.png", "8192");
    expect_refused(make_progressive_jpg(8192, 0), "wide.jpg", "8192");
}

TEST(PictureBudget, PackedPicturesOfOldFormatsAreRefused)
{
    std::vector<std::byte> tga = bytes_of({ 0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x1f, 0, 0x1f, 24, 0 });
    for (int i = 0; i < 7936 * 7936 / 128; i++)
        for (const int byte : { 0xff, 1, 2, 3 })
            tga.push_back(std::byte(byte));
    tga.resize(vkpt::tests::small_file_bytes - 1);
    expect_refused(tga, "runs.tga", "7936");
    std::vector<std::byte> pcx = write_pcx(make_indexed_image(1, 1));
    for (const size_t at : { 9, 11 })
        pcx[at] = std::byte { 0x1f };
    std::vector<std::byte> runs;
    while (pcx.size() + runs.size() + 2 < vkpt::tests::small_file_bytes)
        runs.insert(runs.end(), { std::byte { 0xff }, std::byte { 7 } });
    pcx.insert(pcx.begin() + 128, runs.begin(), runs.end());
    expect_refused(pcx, "runs.pcx", "7937");
}

TEST(PictureBudget, TheLargestOrdinaryPicturesAreRead)
{
    for (const int interlace : { 0, 1 })
        for (const int bits : { 8, 16 }) {
            const Cost cost
                = expect_cheap(make_black_png({ 4096, 4096, uint8_t(bits), 6, uint8_t(interlace) }), "4096.png");
            EXPECT_EQ(cost.outcome, "read") << bits << " bits, interlace " << interlace;
        }
    EXPECT_EQ(expect_cheap(make_progressive_jpg(4096, 0), "4096.jpg").outcome, "read");
}

TEST(PictureBudget, LargerOnesAreReadFromFilesThatHoldThem)
{
    const Image image { 4200, 4100, std::vector<Rgba8>(size_t(4200) * 4100) };
    const auto file = write_tga(image);
    EXPECT_EQ(read_image(file, "a.tga", {}).pixels.size(), image.pixels.size());
}

TEST(PictureBudget, PngChunksMayLie)
{
    const PngHeader header { .width = 64, .height = 64 };
    const std::string pixels = deflated_zeros(64 * (64 * 4 + 1));
    for (const uint32_t length : { 0x70000000u, 0x7fffffffu, 0xffffffffu })
        expect_refused(PngWriter(header).chunk_with_length("IDAT", pixels, length).finish(), "length.png", "PNG");
    const std::string profile = "icc" + std::string(2, '\0') + deflated_zeros(size_t(800) << 20);
    EXPECT_EQ(
        expect_cheap(PngWriter(header).chunk("iCCP", profile).chunk("IDAT", pixels).finish(), "profile.png").outcome,
        "read");
    const std::string text = "key" + std::string(2, '\0') + deflated_zeros(size_t(7) << 20);
    PngWriter many(header);
    for (int i = 0; i < 100; i++)
        many.chunk("zTXt", text);
    EXPECT_EQ(expect_cheap(many.chunk("IDAT", pixels).finish(), "texts.png").outcome, "read");
}

TEST(PictureBudget, PngDataBehindThePictureIsBounded)
{
    expect_cheap(
        PngWriter({ .width = 64, .height = 64 }).chunk("IDAT", deflated_zeros(size_t(900) << 20)).finish(), "more.png");
}

TEST(PictureBudget, ScansAreCounted)
{
    const auto file = make_progressive_jpg(2048, 20000);
    expect_refused(file, "scans.jpg", "scans");
}

TEST(PictureBudget, DamagedHuffmanTablesAreRefused)
{
    const auto file = vkpt::tests::file_bytes(VKPT_BAD_FILES "/jpg_huffman_overrun.jpg");
    const Cost cost = expect_cheap(file, "overrun.jpg");
    EXPECT_TRUE(cost.ended);
    EXPECT_TRUE(cost.refused()) << cost.outcome;
}

TEST(PictureBudget, BadPicturesStayBad)
{
    for (const auto& path : vkpt::tests::files_in(VKPT_BAD_FILES, ".jpg"))
        expect_cheap(vkpt::tests::file_bytes(path), path.string());
}

} // namespace

} // namespace formats
