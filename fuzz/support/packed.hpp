// SPDX-License-Identifier: GPL-2.0-or-later
// zlib's packed data within files.
#pragma once

#include "fuzz/support/mutate.hpp"

#include <zlib.h>

namespace vkpt::fuzz {

// As much as can be unpacked, at most `limit` bytes.
inline File unpack(const File& packed, size_t limit)
{
    File raw(limit);
    z_stream stream {};
    if (inflateInit(&stream) != Z_OK)
        return {};
    stream.next_in = const_cast<Bytef*>(packed.data());
    stream.avail_in = uInt(packed.size());
    stream.next_out = raw.data();
    stream.avail_out = uInt(raw.size());
    inflate(&stream, Z_FINISH);
    raw.resize(stream.total_out);
    inflateEnd(&stream);
    return raw;
}

inline File pack(const File& raw)
{
    uLongf size = compressBound(uLong(raw.size()));
    File packed(size);
    if (compress2(packed.data(), &size, raw.data(), uLong(raw.size()), 1) != Z_OK)
        size = 0;
    packed.resize(size);
    return packed;
}

} // namespace vkpt::fuzz
