// SPDX-License-Identifier: GPL-2.0-or-later
// OpenEXR 2 pictures: one part of scan lines, three float32 channels, ZIP compression ("OpenEXR File Layout",
// openexr.com).
#include "formats/byte_writer.hpp"
#include "formats/image.hpp"

#include <algorithm>
#include <array>
#include <zlib.h>

namespace formats {

namespace {

constexpr uint32_t magic = 20000630, version = 2;
constexpr int lines_per_chunk = 16; // of ZIP compression
constexpr uint8_t zip_compression = 3, increasing_y = 0;
constexpr int32_t float_pixels = 2;
constexpr std::array<char, 3> channel_names { 'B', 'G', 'R' }; // in the alphabet's order
constexpr std::array<size_t, 3> channel_places { 2, 1, 0 }; // in our pixels

void write_text(ByteWriter& to, std::string_view text)
{
    to.write_bytes(std::as_bytes(std::span(text)));
    to.write(char(0));
}

template <class Value> void write_attribute(ByteWriter& to, const char* name, const char* type, const Value& value)
{
    write_text(to, name);
    write_text(to, type);
    to.write(int32_t(sizeof value));
    to.write(value);
}

void write_channels(ByteWriter& to)
{
    ByteWriter list;
    for (const char name : channel_names) {
        list.write(name);
        list.write(char(0));
        list.write(float_pixels);
        list.write(int32_t(0)); // perceptually linear: no
        list.write(std::array<int32_t, 2> { 1, 1 }); // every pixel is there
    }
    list.write(char(0));
    const std::vector<std::byte> bytes = list.take();
    write_text(to, "channels");
    write_text(to, "chlist");
    to.write(int32_t(bytes.size()));
    to.write_bytes(bytes);
}

void write_header(ByteWriter& to, int width, int height)
{
    to.write(magic);
    to.write(version);
    write_channels(to);
    write_attribute(to, "compression", "compression", zip_compression);
    const std::array<int32_t, 4> window { 0, 0, width - 1, height - 1 };
    write_attribute(to, "dataWindow", "box2i", window);
    write_attribute(to, "displayWindow", "box2i", window);
    write_attribute(to, "lineOrder", "lineOrder", increasing_y);
    write_attribute(to, "pixelAspectRatio", "float", 1.0f);
    write_attribute(to, "screenWindowCenter", "v2f", std::array<float, 2> { 0, 0 });
    write_attribute(to, "screenWindowWidth", "float", 1.0f);
    to.write(char(0));
}

// Lines of one channel after the other.
std::vector<std::byte> gather_lines(std::span<const float> rgb, size_t width, size_t first, size_t end)
{
    ByteWriter bytes;
    for (size_t y = first; y < end; y++)
        for (const size_t channel : channel_places)
            for (size_t x = 0; x < width; x++)
                bytes.write(rgb[(y * width + x) * 3 + channel]);
    return bytes.take();
}

// Even bytes, then odd ones, each as its difference to the one before; deflated. What does not become smaller stays as
// it is.
std::vector<std::byte> compress(std::vector<std::byte> raw)
{
    std::vector<uint8_t> split(raw.size());
    for (size_t i = 0; i < raw.size(); i++)
        split[i / 2 + (i % 2) * ((raw.size() + 1) / 2)] = uint8_t(raw[i]);
    for (size_t i = split.size(); i-- > 1;)
        split[i] = uint8_t(split[i] - split[i - 1] + 128);
    uLongf size = compressBound(uLong(split.size()));
    std::vector<std::byte> packed(size);
    const int result = compress2(
        reinterpret_cast<Bytef*>(packed.data()), &size, split.data(), uLong(split.size()), Z_DEFAULT_COMPRESSION);
    if (result != Z_OK || size >= raw.size())
        return raw;
    packed.resize(size);
    return packed;
}

} // namespace

std::vector<std::byte> write_exr(int width, int height, std::span<const float> rgb)
{
    ByteWriter file;
    write_header(file, width, height);
    const size_t table = file.position();
    const int chunks = (height + lines_per_chunk - 1) / lines_per_chunk;
    for (int i = 0; i < chunks; i++)
        file.write(uint64_t(0)); // offsets, known only later
    for (int i = 0; i < chunks; i++) {
        file.patch(table + size_t(i) * sizeof(uint64_t), uint64_t(file.position()));
        const int first = i * lines_per_chunk, end = std::min(first + lines_per_chunk, height);
        const std::vector<std::byte> packed = compress(gather_lines(rgb, size_t(width), size_t(first), size_t(end)));
        file.write(int32_t(first));
        file.write(int32_t(packed.size()));
        file.write_bytes(packed);
    }
    return file.take();
}

} // namespace formats
