// SPDX-License-Identifier: GPL-2.0-or-later
// Changes to inputs that keep what only a writer gets right (directories, counts, checksums, compression), so that the
// rest of a reader is reached. Each takes an input of its kind and gives another, at most `limit` bytes long; what is
// not of its kind, and one input in ten, is changed byte by byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace vkpt::fuzz {

using File = std::vector<uint8_t>;
using Random = std::minstd_rand;

File mutate_bsp(const File& file, size_t limit, Random& random);
File mutate_md2(const File& file, size_t limit, Random& random);
File mutate_png(const File& file, size_t limit, Random& random);
File mutate_trace(const File& file, size_t limit, Random& random);
// Rows of calls (frames_fuzzer.cpp) and other inputs that are all numbers: fields of 4 bytes get numbers that hurt.
File mutate_numbers(const File& file, size_t limit, Random& random);

} // namespace vkpt::fuzz
