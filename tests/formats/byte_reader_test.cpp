// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/byte_reader.hpp"

#include <array>
#include <gtest/gtest.h>

namespace formats {

namespace {

constexpr std::array<std::byte, 6> six { std::byte { 0x01 }, std::byte { 0x02 }, std::byte { 'a' }, std::byte { 0 },
    std::byte { 'b' }, std::byte { 0xff } };

TEST(ByteReader, ReadsLittleEndianUnaligned)
{
    ByteReader reader(six, "six");
    reader.seek(1);
    EXPECT_EQ(reader.read<uint16_t>(), 0x6102);
    EXPECT_EQ(reader.position(), 3u);
    EXPECT_EQ(reader.remaining(), 3u);
}

TEST(ByteReader, StringsEndAtZeroOrAtTheField)
{
    ByteReader reader(six, "six");
    reader.seek(2);
    EXPECT_EQ(reader.read_string(3), "a");
    EXPECT_EQ(reader.position(), 5u);
    reader.seek(2);
    EXPECT_EQ(reader.read_string(1), "a");
}

TEST(ByteReader, RefusesWhatLiesBeyondTheEnd)
{
    ByteReader reader(six, "six");
    EXPECT_THROW(reader.seek(7), FormatError);
    reader.seek(6);
    EXPECT_THROW(reader.read<uint8_t>(), FormatError);
    EXPECT_THROW(reader.read_array<uint16_t>(0, 4, "numbers"), FormatError);
    EXPECT_THROW(reader.read_array<uint16_t>(0, SIZE_MAX / 2 + 2, "numbers"), FormatError); // count * 2 overflows
    EXPECT_THROW(reader.read_array<uint16_t>(SIZE_MAX, 1, "numbers"), FormatError);
    EXPECT_EQ(reader.read_array<uint16_t>(0, 3, "numbers").size(), 3u);
}

TEST(ByteReader, ErrorsNameFileOffsetAndReason)
{
    ByteReader reader(six, "maps/six.bsp");
    reader.seek(4);
    try {
        reader.read<uint32_t>();
        FAIL();
    } catch (const FormatError& error) {
        EXPECT_EQ(error.file(), "maps/six.bsp");
        EXPECT_EQ(error.offset(), 4u);
        EXPECT_NE(std::string(error.what()).find("maps/six.bsp: at byte 4: "), std::string::npos);
        EXPECT_NE(error.reason().find("2 left"), std::string::npos);
    }
}

} // namespace

} // namespace formats
