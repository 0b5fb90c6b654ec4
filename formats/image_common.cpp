// SPDX-License-Identifier: GPL-2.0-or-later
// The choice of a reader by a file's content; writing PNG (by stb) and PFM.
#include "formats/byte_writer.hpp"
#include "formats/image_jpg.hpp"
#include "formats/image_png.hpp"
#include "formats/image_room.hpp"
#include "formats/image_size.hpp"
#include "formats/image_tga.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Wunknown-warning-option"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wshadow"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace formats {

Image read_common_image(Bytes file, std::string_view name) { return read_common_image(file, name, max_pixels); }

Image read_common_image(Bytes file, std::string_view name, size_t room)
{
    if (is_png(file))
        return read_png(file, name, room);
    if (is_jpg(file))
        return read_jpg(file, name, room);
    return read_tga(file, name, room);
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
