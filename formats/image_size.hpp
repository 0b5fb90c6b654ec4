// SPDX-License-Identifier: GPL-2.0-or-later
// What every picture's size must obey, in files read and in pictures to write.
#pragma once

#include "formats/image.hpp"

#include <cstdint>

namespace formats {

inline std::string size_text(int64_t width, int64_t height)
{
    return std::to_string(width) + " x " + std::to_string(height);
}

inline void check_image_size(const ByteReader& reader, size_t offset, int64_t width, int64_t height)
{
    if (width < 1 || height < 1 || width > max_image_size || height > max_image_size)
        reader.fail_at(offset, "a picture of " + size_text(width, height) + " pixels");
}

// Of a size that check_image_size() has let through; before memory is taken for it. `room`: see image_room.hpp.
inline void check_pixel_budget(const ByteReader& reader, int64_t width, int64_t height, size_t room = max_pixels)
{
    const size_t pixels = size_t(width) * size_t(height);
    if (pixels > room && room < max_pixels)
        reader.fail_at(0,
            "a picture of " + size_text(width, height) + " pixels, where the pictures before it have left room for "
                + std::to_string(room) + "; make them smaller");
    if (pixels > max_pixels || (pixels > max_pixels_of_any_file && pixels / max_pixels_per_byte > reader.size()))
        reader.fail_at(0,
            "a picture of " + size_text(width, height) + " pixels in " + std::to_string(reader.size())
                + " bytes is over the limit of 4096 x 4096; make it smaller");
}

[[noreturn]] inline void fail_too_little_data(const ByteReader& reader, int64_t width, int64_t height)
{
    reader.fail_at(0, "too little data for a picture of " + size_text(width, height));
}

inline void check_written_image(int width, int height, size_t pixel_count)
{
    if (width < 1 || height < 1 || width > max_image_size || height > max_image_size
        || pixel_count != size_t(width) * size_t(height))
        throw std::invalid_argument("cannot write a picture of " + std::to_string(width) + " x "
            + std::to_string(height) + " with " + std::to_string(pixel_count) + " pixels");
}

} // namespace formats
