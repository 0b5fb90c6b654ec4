// SPDX-License-Identifier: GPL-2.0-or-later
// Bytes as text (RFC 4648), for pictures within pages and JSON.
#pragma once

#include "formats/byte_reader.hpp"

#include <cstdint>
#include <string>

namespace vkpt::client {

inline std::string encode_base64(formats::Bytes bytes)
{
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t count = std::min<size_t>(3, bytes.size() - i);
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; k++)
            bits = bits << 8 | (k < count ? uint32_t(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; k++)
            text += k <= count ? digits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

} // namespace vkpt::client
