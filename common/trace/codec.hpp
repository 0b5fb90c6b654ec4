// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers of a trace as bytes. Encoder and Decoder have the same calls, so that one function describes both directions.
#pragma once

#include "formats/byte_reader.hpp"
#include "formats/byte_writer.hpp"

#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace vkpt::trace {

// Small magnitudes of either sign become small numbers: 0, -1, 1, -2 ... as 0, 1, 2, 3 ...
constexpr uint32_t fold_sign(int32_t value) { return (uint32_t(value) << 1) ^ uint32_t(value >> 31); }
constexpr int32_t unfold_sign(uint32_t folded) { return int32_t(folded >> 1) ^ -int32_t(folded & 1); }

// Seven bits a byte, lowest first; the top bit says that more follow.
class Encoder {
public:
    static constexpr bool is_encoder = true;

    void number(uint32_t& value)
    {
        uint32_t rest = value;
        for (; rest >= 0x80; rest >>= 7)
            bytes_.write(uint8_t(rest | 0x80));
        bytes_.write(uint8_t(rest));
    }
    // Near to what both sides expect: costs one byte where it is right or nearly so. Wraps around.
    void near_number(uint32_t& value, uint32_t expected)
    {
        uint32_t folded = fold_sign(int32_t(value - expected));
        number(folded);
    }
    void real(float& value) { bytes_.write(value); }
    void text(std::string& text)
    {
        uint32_t length = uint32_t(text.size());
        number(length);
        bytes_.write_bytes(std::as_bytes(std::span(text)));
    }
    void data(std::vector<std::byte>& data)
    {
        uint32_t length = uint32_t(data.size());
        number(length);
        bytes_.write_bytes(data);
    }

    // What a decoder must not believe; here it is our own.
    void check(bool, std::string_view) const { }

    size_t size() const { return bytes_.position(); }
    std::vector<std::byte> take() { return std::exchange(bytes_, {}).take(); }

private:
    formats::ByteWriter bytes_;
};

// Throws FormatError for what no encoder writes.
class Decoder {
public:
    static constexpr bool is_encoder = false;

    Decoder(formats::Bytes bytes, std::string_view file)
        : reader_(bytes, file)
    {
    }

    void number(uint32_t& value)
    {
        value = 0;
        for (int shift = 0; shift < 35; shift += 7) {
            const auto byte = reader_.read<uint8_t>();
            value |= uint32_t(byte & 0x7f) << shift;
            if (!(byte & 0x80))
                return;
        }
        fail("a number of more than 32 bits");
    }
    void near_number(uint32_t& value, uint32_t expected)
    {
        uint32_t folded = 0;
        number(folded);
        value = expected + uint32_t(unfold_sign(folded));
    }
    void real(float& value) { value = reader_.read<float>(); }
    void text(std::string& text)
    {
        const formats::Bytes bytes = take();
        text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
    void data(std::vector<std::byte>& data)
    {
        const formats::Bytes bytes = take();
        data.assign(bytes.begin(), bytes.end());
    }

    void check(bool is_possible, std::string_view reason_if_not) const
    {
        if (!is_possible)
            fail(reason_if_not);
    }
    bool is_at_end() const { return reader_.remaining() == 0; }
    [[noreturn]] void fail(std::string_view reason) const { reader_.fail(reason); }

private:
    formats::Bytes take()
    {
        uint32_t length = 0;
        number(length);
        return reader_.take(length);
    }

    formats::ByteReader reader_;
};

} // namespace vkpt::trace
