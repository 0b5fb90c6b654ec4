// SPDX-License-Identifier: GPL-2.0-or-later
// FNV-1a with 64 bits (Fowler, Noll, Vo): tells contents apart that nobody forges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace vkpt {

inline constexpr uint64_t hash_start = 0xcbf29ce484222325;

inline uint64_t hash_bytes(std::span<const std::byte> bytes, uint64_t hash = hash_start)
{
    for (const std::byte byte : bytes)
        hash = (hash ^ uint64_t(byte)) * 0x100000001b3;
    return hash;
}

} // namespace vkpt
