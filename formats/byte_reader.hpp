// SPDX-License-Identifier: GPL-2.0-or-later
// The one door through which untrusted bytes enter: every read is checked against the file's end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace formats {

using Bytes = std::span<const std::byte>;

// A file that cannot be read: which one, where in it (byte offset), and why.
class FormatError : public std::runtime_error {
public:
    FormatError(std::string_view file, size_t offset, std::string_view reason);

    const std::string& file() const { return file_; }
    size_t offset() const { return offset_; }
    const std::string& reason() const { return reason_; }

private:
    std::string file_;
    size_t offset_;
    std::string reason_;
};

// A window onto a file's bytes. Little-endian, unaligned; throws FormatError instead of reading past the end.
class ByteReader {
public:
    ByteReader(Bytes bytes, std::string_view file)
        : bytes_(bytes)
        , file_(file)
    {
    }

    size_t size() const { return bytes_.size(); }
    size_t position() const { return position_; }
    size_t remaining() const { return bytes_.size() - position_; }
    const std::string& file() const { return file_; }

    void seek(size_t offset);

    template <class T> T read()
    {
        static_assert(std::is_trivially_copyable_v<T>);
        T value;
        std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
        return value;
    }

    // The next `count` bytes, as a view into the file.
    Bytes take(size_t count);

    // A fixed-size field holding a zero-terminated (or full) string.
    std::string read_string(size_t field_size);

    // `count` packed records from absolute `offset`.
    template <class T> std::vector<T> read_array(size_t offset, size_t count, std::string_view what)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        check_range(offset, count, sizeof(T), what);
        std::vector<T> items(count);
        if (count > 0)
            std::memcpy(items.data(), bytes_.data() + offset, count * sizeof(T));
        return items;
    }

    [[noreturn]] void fail(std::string_view reason) const { throw FormatError(file_, position_, reason); }
    [[noreturn]] void fail_at(size_t offset, std::string_view reason) const
    {
        throw FormatError(file_, offset, reason);
    }

private:
    void check_range(size_t offset, size_t count, size_t item_size, std::string_view what) const;

    Bytes bytes_;
    std::string file_;
    size_t position_ = 0;
};

} // namespace formats
