// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/formats/picture_bombs.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <zlib.h>

#include <jpeglib.h>

namespace vkpt::samples {

namespace {

std::string big_endian(uint32_t number)
{
    return { char(number >> 24), char(number >> 16 & 0xff), char(number >> 8 & 0xff), char(number & 0xff) };
}

std::vector<std::byte> to_bytes(const std::string& text)
{
    std::vector<std::byte> bytes(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
}

// A raw piece of a compressed stream that stands for itself and ends on a whole byte.
std::string deflated_piece(const std::string& data)
{
    z_stream stream {};
    if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::runtime_error("no compressor");
    std::string packed(compressBound(data.size()) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
    stream.avail_in = uInt(data.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    deflate(&stream, Z_FULL_FLUSH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

} // namespace

PngWriter::PngWriter(const PngHeader& header)
    : text_("\x89PNG\r\n\x1a\n")
{
    chunk("IHDR",
        big_endian(header.width) + big_endian(header.height)
            + std::string { char(header.bits), char(header.colour_type), 0, 0, char(header.interlace) });
}

PngWriter& PngWriter::chunk(const std::string& type, const std::string& data)
{
    return chunk_with_length(type, data, uint32_t(data.size()));
}

PngWriter& PngWriter::chunk_with_length(const std::string& type, const std::string& data, uint32_t length)
{
    const std::string body = type + data;
    const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()));
    text_ += big_endian(length) + body + big_endian(uint32_t(sum));
    return *this;
}

std::vector<std::byte> PngWriter::finish()
{
    chunk("IEND", "");
    return to_bytes(text_);
}

std::string deflated_zeros(size_t size)
{
    constexpr size_t piece = size_t(1) << 20;
    const std::string whole = deflated_piece(std::string(piece, '\0'));
    std::string packed = "\x78\xda";
    for (size_t done = 0; done + piece <= size; done += piece)
        packed += whole;
    packed += deflated_piece(std::string(size % piece, '\0'));
    packed += std::string("\x03\x00", 2); // an empty last block
    return packed + big_endian(uint32_t((size % 65521) << 16 | 1)); // Adler's sum of zeros
}

std::vector<std::byte> make_black_png(const PngHeader& header)
{
    constexpr size_t channels[] { 1, 0, 3, 1, 2, 0, 4 };
    const size_t row = (size_t(header.width) * channels[header.colour_type] * header.bits + 7) / 8 + 1;
    // Interlaced: seven pictures, each of whose rows takes one byte more.
    const size_t size = header.interlace ? row * header.height + size_t(header.height) * 8 : row * header.height;
    return PngWriter(header).chunk("IDAT", deflated_zeros(size)).finish();
}

std::vector<std::byte> make_progressive_jpg(int size, int scans)
{
    jpeg_compress_struct info {};
    jpeg_error_mgr errors {};
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* packed = nullptr;
    unsigned long packed_size = 0;
    jpeg_mem_dest(&info, &packed, &packed_size);
    info.image_width = info.image_height = JDIMENSION(size);
    info.input_components = 1;
    info.in_color_space = JCS_GRAYSCALE;
    jpeg_set_defaults(&info);
    jpeg_simple_progression(&info);
    jpeg_start_compress(&info, TRUE);
    std::vector<unsigned char> pixels(size_t(size), 100);
    for (int y = 0; y < size; y++) {
        JSAMPROW row = pixels.data();
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    std::string text(reinterpret_cast<char*>(packed), packed_size);
    std::free(packed);
    const size_t last_scan = text.rfind("\xff\xda"), end = text.rfind("\xff\xd9");
    const std::string scan = text.substr(last_scan, end - last_scan);
    std::string more;
    for (int i = 0; i < scans; i++)
        more += scan;
    return to_bytes(text.substr(0, end) + more + text.substr(end));
}

} // namespace vkpt::samples
