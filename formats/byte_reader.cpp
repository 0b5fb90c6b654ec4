// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/byte_reader.hpp"

#include <algorithm>
#include <bit>

namespace formats {

static_assert(std::endian::native == std::endian::little, "Quake II's files are read as they lie in memory");

FormatError::FormatError(std::string_view file, size_t offset, std::string_view reason)
    : std::runtime_error(std::string(file) + ": at byte " + std::to_string(offset) + ": " + std::string(reason))
    , file_(file)
    , offset_(offset)
    , reason_(reason)
{
}

void ByteReader::seek(size_t offset)
{
    if (offset > bytes_.size())
        fail_at(offset, "points past the end of the file (" + std::to_string(bytes_.size()) + " bytes)");
    position_ = offset;
}

Bytes ByteReader::take(size_t count)
{
    if (count > remaining())
        fail("the file ends here: " + std::to_string(count) + " bytes expected, " + std::to_string(remaining())
            + " left");
    const Bytes view = bytes_.subspan(position_, count);
    position_ += count;
    return view;
}

std::string ByteReader::read_string(size_t field_size)
{
    const Bytes field = take(field_size);
    const auto end = std::find(field.begin(), field.end(), std::byte { 0 });
    std::string text(size_t(end - field.begin()), '\0');
    std::transform(field.begin(), end, text.begin(), [](std::byte b) { return char(b); });
    return text;
}

void ByteReader::check_range(size_t offset, size_t count, size_t item_size, std::string_view what) const
{
    // Divided, not multiplied: a hostile count must not overflow.
    if (offset > bytes_.size() || count > (bytes_.size() - offset) / item_size)
        fail_at(offset,
            std::string(what) + ": " + std::to_string(count) + " records of " + std::to_string(item_size)
                + " bytes reach past the end of the file (" + std::to_string(bytes_.size()) + " bytes)");
}

} // namespace formats
