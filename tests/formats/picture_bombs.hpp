// SPDX-License-Identifier: GPL-2.0-or-later
// Small picture files that ask for much: memory or time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vkpt::samples {

struct PngHeader {
    uint32_t width = 0, height = 0;
    uint8_t bits = 8, colour_type = 6; // 0 grey, 2 RGB, 3 palette, 6 RGBA
    uint8_t interlace = 0;
};

// A file of chunks, each with its length and checksum.
class PngWriter {
public:
    explicit PngWriter(const PngHeader& header);
    PngWriter& chunk(const std::string& type, const std::string& data);
    // The length is a lie: `length` stands for the size of `data`.
    PngWriter& chunk_with_length(const std::string& type, const std::string& data, uint32_t length);
    std::vector<std::byte> finish();

private:
    std::string text_;
};

// Compressed zeros, `size` when unpacked; a thousandth of that here.
std::string deflated_zeros(size_t size);
// A black picture as small as PNG can make it.
std::vector<std::byte> make_black_png(const PngHeader& header);
// Grey, progressive, without detail; its last scan is there `scans` times more.
std::vector<std::byte> make_progressive_jpg(int size, int scans);

} // namespace vkpt::samples
