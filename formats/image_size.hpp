// SPDX-License-Identifier: GPL-2.0-or-later
// What every picture's size must obey, in files read and in pictures to write.
#pragma once

#include "formats/image.hpp"

namespace formats {

inline void check_image_size(const ByteReader& reader, size_t offset, int64_t width, int64_t height)
{
    if (width < 1 || height < 1 || width > max_image_size || height > max_image_size)
        reader.fail_at(offset, "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
}

inline void check_written_image(int width, int height, size_t pixel_count)
{
    if (width < 1 || height < 1 || width > max_image_size || height > max_image_size
        || pixel_count != size_t(width) * size_t(height))
        throw std::invalid_argument("cannot write a picture of " + std::to_string(width) + " x "
            + std::to_string(height) + " with " + std::to_string(pixel_count) + " pixels");
}

} // namespace formats
