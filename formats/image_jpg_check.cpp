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

// Tables that the file's end cuts off cannot overflow: the decoder reads zeros there.
void check_segment(ByteReader reader)
{
    if (reader.remaining() < 2)
        return;
    const auto length = reader.read<std::array<uint8_t, 2>>();
    int left = (length[0] << 8 | length[1]) - 2;
    while (left > 0 && reader.remaining() >= 17) {
        const size_t start = reader.position();
        reader.take(1);
        int codes = 0;
        for (const uint8_t count : reader.read<std::array<uint8_t, 16>>())
            codes += count;
        if (codes > 256)
            reader.fail_at(start, "JPG: a Huffman table of " + std::to_string(codes) + " codes");
        if (size_t(codes) > reader.remaining())
            return;
        reader.take(size_t(codes));
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
