// SPDX-License-Identifier: GPL-2.0-or-later
// A file as tables of records, and changes to them.
#pragma once

#include "fuzz/support/mutate.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

namespace vkpt::fuzz {

// Any number of the kind T at `offset`; past the end: zero.
template <class T> T get(const File& file, size_t offset)
{
    T value {};
    if (offset <= file.size() && file.size() - offset >= sizeof(T))
        std::memcpy(&value, file.data() + offset, sizeof(T));
    return value;
}
template <class T> void put(File& file, size_t offset, const T& value)
{
    if (offset <= file.size() && file.size() - offset >= sizeof(T))
        std::memcpy(file.data() + offset, &value, sizeof(T));
}
template <class T> void append(File& file, const T& value)
{
    const auto* bytes = reinterpret_cast<const uint8_t*>(&value);
    file.insert(file.end(), bytes, bytes + sizeof(T));
}

// As much of [offset, offset + size) as the file has.
File cut(const File& file, uint64_t offset, uint64_t size);

inline size_t pick(Random& random, size_t count) { return random() % count; }

// libFuzzer's own changes to plain bytes; a plainer stand-in in programs without libFuzzer.
File mutate_bytes(File file, size_t limit, Random& random);

struct Table {
    File bytes;
    size_t record_size = 1; // 1: no records, text or packed bytes
};

// One change to one of the tables, or between two of them.
void mutate_tables(std::vector<Table>& tables, size_t limit, Random& random);
// One change to a table's records.
void mutate_table(Table& table, size_t limit, Random& random);
// One field of 1, 2 or 4 bytes.
void mutate_field(File& bytes, size_t first, size_t size, Random& random);

} // namespace vkpt::fuzz
