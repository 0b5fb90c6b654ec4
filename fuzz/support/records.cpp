// SPDX-License-Identifier: GPL-2.0-or-later
#include "fuzz/support/records.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>

// libFuzzer's, where the program is linked with it.
extern "C" __attribute__((weak)) size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t most);

namespace vkpt::fuzz {

namespace {

constexpr uint32_t hostile_numbers[] { 0, 1, 2, 3, 0x7f, 0x80, 0xff, 0x100, 0x7fff, 0x8000, 0xffff, 0x10000, 0x00ffffff,
    0x01000000, 0x40000000, 0x7ffffffe, 0x7fffffff, 0x80000000, 0x80000001, 0xfffffffe, 0xffffffff };

const float hostile_reals[] { 0, -0.0f, 1, -1, 0.5f, 1e-30f, 1e-45f, 0.01f, 16, 255, 4096, -4096, 65536, 16777216, 1e6f,
    -1e6f, 2147483648.0f, 1e10f, 1e15f, 1e20f, 1e38f, -1e38f, std::numeric_limits<float>::infinity(),
    std::numeric_limits<float>::quiet_NaN() };

uint32_t make_number(uint32_t old, Random& random)
{
    switch (pick(random, 7)) {
    case 0:
        return hostile_numbers[pick(random, std::size(hostile_numbers))];
    case 1:
        return std::bit_cast<uint32_t>(hostile_reals[pick(random, std::size(hostile_reals))]);
    case 2:
        return old + uint32_t(pick(random, 33)) - 16;
    case 3:
        return uint32_t(pick(random, 64));
    case 4:
        return old ^ 1u << pick(random, 32);
    case 5: // a float somewhat larger or smaller
        return std::bit_cast<uint32_t>(std::bit_cast<float>(old) * (0.5f + float(pick(random, 1000)) * 0.002f));
    default:
        return uint32_t(random()) << 8 ^ uint32_t(random());
    }
}

} // namespace

File cut(const File& file, uint64_t offset, uint64_t size)
{
    if (offset >= file.size())
        return {};
    const auto first = file.begin() + ptrdiff_t(offset);
    return { first, first + ptrdiff_t(std::min<uint64_t>(size, file.size() - offset)) };
}

File mutate_bytes(File file, size_t limit, Random& random)
{
    if (LLVMFuzzerMutate) {
        const size_t size = std::min(file.size(), limit);
        file.resize(limit);
        file.resize(LLVMFuzzerMutate(file.data(), size, limit));
        return file;
    }
    if (file.size() < limit && (file.empty() || pick(random, 4) == 0))
        file.insert(file.begin() + ptrdiff_t(pick(random, file.size() + 1)), uint8_t(random()));
    else if (pick(random, 8) == 0)
        file.resize(pick(random, file.size()));
    else
        file[pick(random, file.size())] ^= uint8_t(1 << pick(random, 8));
    file.resize(std::min(file.size(), limit));
    return file;
}

void mutate_field(File& bytes, size_t first, size_t size, Random& random)
{
    if (first >= bytes.size())
        return;
    size = std::min(size, bytes.size() - first);
    const size_t width = size >= 4 && pick(random, 4) != 0 ? 4 : size >= 2 && pick(random, 4) != 0 ? 2 : 1;
    const size_t place = first + pick(random, size / width) * width;
    uint32_t old = 0;
    std::memcpy(&old, bytes.data() + place, width);
    const uint32_t number = make_number(old, random);
    std::memcpy(bytes.data() + place, &number, width);
}

void mutate_table(Table& table, size_t limit, Random& random)
{
    File& bytes = table.bytes;
    const size_t size = table.record_size;
    if (size == 1 || bytes.size() < size) {
        bytes = mutate_bytes(std::move(bytes), limit, random);
        return;
    }
    const size_t count = bytes.size() / size, a = pick(random, count) * size, b = pick(random, count) * size;
    const auto at = [&](size_t place) { return bytes.begin() + ptrdiff_t(place); };
    switch (pick(random, 10)) {
    case 0: // one more
        if (bytes.size() + size <= limit) {
            const File copy(at(a), at(a + size));
            bytes.insert(at(b), copy.begin(), copy.end());
        }
        break;
    case 1:
        bytes.erase(at(a), at(a + size));
        break;
    case 2:
        std::swap_ranges(at(a), at(a + size), at(b));
        break;
    case 3: { // one field of one like that of another
        const size_t field = pick(random, (size + 3) / 4) * 4, width = std::min<size_t>(4, size - field);
        std::copy_n(File(at(b + field), at(b + field + width)).begin(), width, at(a + field));
        break;
    }
    case 4: // many more
        while (bytes.size() + size <= limit && pick(random, 16) != 0) {
            const File copy(at(a), at(a + size));
            bytes.insert(bytes.end(), copy.begin(), copy.end());
        }
        break;
    default:
        mutate_field(bytes, a, size, random);
        break;
    }
}

void mutate_tables(std::vector<Table>& tables, size_t limit, Random& random)
{
    if (tables.empty())
        return;
    Table& table = tables[pick(random, tables.size())];
    Table& other = tables[pick(random, tables.size())];
    switch (pick(random, 24)) {
    case 0:
        std::swap(table.bytes, other.bytes);
        break;
    case 1:
        table.bytes.clear();
        break;
    case 2:
        table.bytes = other.bytes;
        break;
    default:
        mutate_table(table, limit, random);
        break;
    }
}

} // namespace vkpt::fuzz
