// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/image_jpg_check.hpp"

#include <algorithm>
#include <array>

namespace formats {

namespace {

enum Marker : uint8_t {
    DefineHuffman = 0xc4,
    StartOfScan = 0xda,
    FirstApplication = 0xe0,
    LastApplication = 0xef,
    Comment = 0xfe,
    Lead = 0xff,
};

// The decoder reads zeros behind the file's end, and so does this.
uint8_t next_byte(ByteReader& reader) { return reader.remaining() > 0 ? reader.read<uint8_t>() : 0; }

void check_segment(ByteReader reader)
{
    const int high = next_byte(reader), low = next_byte(reader);
    int left = (high << 8 | low) - 2;
    while (left > 0 && reader.remaining() > 0) {
        const size_t start = reader.position();
        next_byte(reader); // which table
        int codes = 0;
        for (int bits = 1; bits <= 16; bits++)
            codes += next_byte(reader);
        if (codes > 256)
            reader.fail_at(start, "JPG: a Huffman table of " + std::to_string(codes) + " codes");
        reader.take(std::min(size_t(codes), reader.remaining()));
        left -= 17 + codes;
    }
}

// Moves past what comes before a picture's data without being a table: cameras put whole pictures into it.
void skip_segment(ByteReader& reader)
{
    if (reader.remaining() < 2)
        return;
    const auto length = reader.read<std::array<uint8_t, 2>>();
    const size_t size = size_t(length[0] << 8 | length[1]);
    reader.seek(reader.position() + std::min(size < 2 ? 0 : size - 2, reader.remaining()));
}

} // namespace

void check_huffman_tables(Bytes jpg, std::string_view name)
{
    ByteReader reader(jpg, name);
    bool in_header = true; // until the first scan; behind it every byte is suspected
    while (reader.remaining() >= 2) {
        if (reader.read<uint8_t>() != Lead)
            continue;
        uint8_t marker = Lead;
        while (marker == Lead && reader.remaining() > 0)
            marker = reader.read<uint8_t>();
        if (marker == DefineHuffman)
            check_segment(reader);
        else if (marker == StartOfScan)
            in_header = false;
        else if (in_header && ((marker >= FirstApplication && marker <= LastApplication) || marker == Comment))
            skip_segment(reader);
    }
}

} // namespace formats
