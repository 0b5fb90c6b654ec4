// SPDX-License-Identifier: GPL-2.0-or-later
// What every harness has: the entry point that libFuzzer calls, and how a harness says that a rule was broken.
#pragma once

#include "formats/byte_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace vkpt::fuzz {

inline formats::Bytes bytes_of(const uint8_t* data, size_t size)
{
    return { reinterpret_cast<const std::byte*>(data), size };
}
inline std::string_view text_of(const uint8_t* data, size_t size)
{
    return { reinterpret_cast<const char*>(data), size };
}

// Ends the program where a promise of the tested code is broken; works in every kind of build.
inline void require(bool holds, const char* promise)
{
    if (holds)
        return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

// Keeps the optimiser from leaving out what makes `value`.
template <class T> void use(const T& value) { asm volatile("" : : "r"(&value) : "memory"); }

} // namespace vkpt::fuzz
