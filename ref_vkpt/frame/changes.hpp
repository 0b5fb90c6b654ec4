// SPDX-License-Identifier: GPL-2.0-or-later
// Brings a copy up to date by writing only what differs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace vkpt {

// `target` holds what `held` says and is not read (memory of the device may be slow to read); afterwards both hold
// `now`. `target` has room for it. Returns the bytes written: whole blocks.
inline size_t write_changes(std::byte* target, std::vector<std::byte>& held, std::span<const std::byte> now)
{
    constexpr size_t block_bytes = 256;
    const size_t known = std::min(held.size(), now.size());
    held.resize(now.size());
    size_t written = 0;
    for (size_t first = 0; first < now.size(); first += block_bytes) {
        const size_t bytes = std::min(block_bytes, now.size() - first);
        if (first + bytes <= known && std::memcmp(&held[first], &now[first], bytes) == 0)
            continue;
        std::memcpy(target + first, &now[first], bytes);
        std::memcpy(&held[first], &now[first], bytes);
        written += bytes;
    }
    return written;
}

} // namespace vkpt
