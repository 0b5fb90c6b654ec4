// SPDX-License-Identifier: GPL-2.0-or-later
// A trace file: a header, then chunks, each whole in itself, so that a file that was cut off can be played up to the
// cut. All numbers are little-endian.
//
//   header   8 bytes magic, u32 version, u32 CRC of the 12 bytes before
//   chunk    ChunkHeader, then `packed_bytes` bytes of zlib's deflate format
//
// Chunk "CALL": calls in codec.hpp's coding, from one end_frame to another; names that are new in the chunk are spelt
// out, views start without a past. Chunk "END ": TraceTotals; a file without it was cut off.
#pragma once

#include "common/trace/calls.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <zlib.h>

namespace vkpt::trace {

inline constexpr std::array<char, 8> file_magic { '\x89', 'R', 'T', 'R', 'A', 'C', 'E', '\n' };
inline constexpr uint32_t file_version = 1;

struct FileHeader {
    std::array<char, 8> magic = file_magic;
    uint32_t version = file_version;
    uint32_t crc = 0;
};
static_assert(sizeof(FileHeader) == 16);

constexpr uint32_t chunk_tag(const char (&text)[5])
{
    return uint32_t(uint8_t(text[0])) | uint32_t(uint8_t(text[1])) << 8 | uint32_t(uint8_t(text[2])) << 16
        | uint32_t(uint8_t(text[3])) << 24;
}
inline constexpr uint32_t tag_calls = chunk_tag("CALL"), tag_end = chunk_tag("END ");

struct ChunkHeader {
    uint32_t tag = 0;
    uint32_t packed_bytes = 0, raw_bytes = 0;
    uint32_t views = 0; // render_view calls in it
    uint32_t payload_crc = 0; // of the packed bytes
    uint32_t crc = 0; // of the 20 bytes before
};
static_assert(sizeof(ChunkHeader) == 24);

struct TraceTotals {
    uint32_t calls = 0, frames = 0, views = 0, zero = 0;

    void count(CallKind kind)
    {
        calls++;
        frames += kind == CallKind::end_frame;
        views += kind == CallKind::render_view;
    }
};

template <class Bytes> uint32_t crc_of(const Bytes& bytes)
{
    return uint32_t(crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), uInt(bytes.size())));
}
// A header's own: of all but its last word.
template <class Header> uint32_t header_crc(const Header& header)
{
    return crc_of(std::as_bytes(std::span(&header, 1)).first(sizeof header - sizeof(uint32_t)));
}

} // namespace vkpt::trace
