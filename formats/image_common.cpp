// SPDX-License-Identifier: GPL-2.0-or-later
// PNG and JPG by stb; PFM.
#include "formats/byte_writer.hpp"
#include "formats/image_jpg_check.hpp"
#include "formats/image_size.hpp"
#include "formats/image_tga.hpp"

#include <cstdlib>
#include <memory>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Wunknown-warning-option"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wshadow"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace formats {

static_assert(STBI_MAX_DIMENSIONS == max_image_size);

namespace {

constexpr std::array<uint8_t, 8> png_signature { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
constexpr std::array<uint8_t, 2> jpg_signature { 0xff, 0xd8 };

template <size_t N> bool starts_with(Bytes file, const std::array<uint8_t, N>& signature)
{
    return file.size() >= N && std::memcmp(file.data(), signature.data(), N) == 0;
}

// What a PNG unpacks to, in bytes, from its IHDR chunk.
size_t unpacked_png_size(Bytes file, std::string_view name, size_t width, size_t height)
{
    constexpr std::array<size_t, 7> channels { 1, 0, 3, 1, 2, 0, 4 }; // by colour type
    ByteReader reader(file, name);
    reader.seek(24);
    const auto bits = reader.read<uint8_t>(), type = reader.read<uint8_t>();
    if (type >= channels.size() || bits > 16)
        reader.fail_at(24, "PNG: unknown pixel format");
    return height * ((width * channels[type] * bits + 7) / 8 + 1);
}

// Refuses a picture that the file is too small to hold, before memory is taken for it.
void check_density(Bytes file, std::string_view name, size_t width, size_t height)
{
    constexpr size_t deflate_limit = 1040; // bytes out of one byte in, 1032 by the format
    constexpr size_t jpg_pixels_per_byte = 1024; // one bit for a block of 8 x 8, halved for reserve
    const bool too_dense = starts_with(file, png_signature)
        ? unpacked_png_size(file, name, width, height) / deflate_limit > file.size()
        : width * height / jpg_pixels_per_byte > file.size();
    if (too_dense)
        throw FormatError(
            name, 0, "too little data for a picture of " + std::to_string(width) + " x " + std::to_string(height));
}

Image read_by_stb(Bytes file, std::string_view name)
{
    const auto* data = reinterpret_cast<const stbi_uc*>(file.data());
    if (file.size() > size_t(INT32_MAX))
        throw FormatError(name, 0, "the file is larger than 2 GiB");
    if (starts_with(file, jpg_signature))
        check_huffman_tables(file, name);
    int width = 0, height = 0, channels = 0;
    const auto fail
        = [&] { throw FormatError(name, 0, std::string("not a readable picture: ") + stbi_failure_reason()); };
    if (!stbi_info_from_memory(data, int(file.size()), &width, &height, &channels))
        fail();
    check_image_size(ByteReader(file, name), 0, width, height);
    check_density(file, name, size_t(width), size_t(height));
    const std::unique_ptr<stbi_uc, decltype(&std::free)> pixels(
        stbi_load_from_memory(data, int(file.size()), &width, &height, &channels, STBI_rgb_alpha), &std::free);
    if (!pixels)
        fail();
    Image image { width, height, std::vector<Rgba8>(size_t(width) * size_t(height)) };
    std::memcpy(image.pixels.data(), pixels.get(), image.pixels.size() * sizeof(Rgba8));
    return image;
}

} // namespace

Image read_common_image(Bytes file, std::string_view name)
{
    if (starts_with(file, png_signature) || starts_with(file, jpg_signature))
        return read_by_stb(file, name);
    return read_tga(file, name);
}

std::vector<std::byte> write_png(const Image& image)
{
    check_written_image(image.width, image.height, image.pixels.size());
    ByteWriter writer;
    const auto append = [](void* context, void* data, int size) {
        static_cast<ByteWriter*>(context)->write_bytes({ static_cast<const std::byte*>(data), size_t(size) });
    };
    if (!stbi_write_png_to_func(append, &writer, image.width, image.height, 4, image.pixels.data(), 0))
        throw std::bad_alloc(); // its only reason to fail
    return writer.take();
}

std::vector<std::byte> write_pfm(int width, int height, std::span<const float> rgb)
{
    if (width < 1 || height < 1 || rgb.size() != size_t(width) * size_t(height) * 3)
        throw std::invalid_argument("write_pfm: " + std::to_string(width) + " x " + std::to_string(height)
            + " pixels from " + std::to_string(rgb.size()) + " numbers");
    const std::string header
        = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n"; // little-endian
    ByteWriter writer;
    writer.write_bytes(std::as_bytes(std::span(header)));
    const size_t row = size_t(width) * 3;
    for (size_t y = size_t(height); y-- > 0;)
        writer.write_array(rgb.subspan(y * row, row));
    return writer.take();
}

} // namespace formats
