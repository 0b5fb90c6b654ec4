// SPDX-License-Identifier: GPL-2.0-or-later
// Builds a file in memory, little-endian: the writers' counterpart of ByteReader.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace formats {

class ByteWriter {
public:
    size_t position() const { return bytes_.size(); }

    template <class T> void write(const T& value)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        write_bytes(std::as_bytes(std::span(&value, 1)));
    }

    template <class T> void write_array(std::span<const T> items)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        write_bytes(std::as_bytes(items));
    }

    void write_bytes(std::span<const std::byte> bytes)
    {
        const size_t start = bytes_.size();
        bytes_.resize(start + bytes.size());
        std::copy(bytes.begin(), bytes.end(), bytes_.begin() + std::ptrdiff_t(start));
    }

    // A fixed-size, zero-filled field. Throws std::invalid_argument if the text does not fit with its final zero.
    void write_string(std::string_view text, size_t field_size)
    {
        if (text.size() >= field_size)
            throw std::invalid_argument("\"" + std::string(text) + "\" is longer than the "
                + std::to_string(field_size - 1) + " bytes it has room for");
        const size_t start = bytes_.size();
        bytes_.resize(start + field_size, std::byte { 0 });
        std::memcpy(bytes_.data() + start, text.data(), text.size());
    }

    // Puts a value where room was left for it earlier.
    template <class T> void patch(size_t offset, const T& value)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        std::memcpy(bytes_.data() + offset, &value, sizeof(T));
    }

    void align(size_t boundary)
    {
        bytes_.resize((bytes_.size() + boundary - 1) / boundary * boundary, std::byte { 0 });
    }

    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
};

} // namespace formats
