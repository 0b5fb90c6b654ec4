// SPDX-License-Identifier: GPL-2.0-or-later
#include "fuzz/support/packed.hpp"
#include "fuzz/support/records.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace vkpt::fuzz {

namespace {

constexpr std::array<uint8_t, 8> signature { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
constexpr size_t max_raw = 1 << 16, max_chunks = 64;

struct Chunk {
    std::array<char, 4> kind;
    File bytes;
};

uint32_t swap_ends(uint32_t n) { return n >> 24 | (n >> 8 & 0xff00) | (n << 8 & 0xff0000) | n << 24; }

std::vector<Chunk> take_chunks(const File& file)
{
    std::vector<Chunk> chunks;
    for (size_t at = signature.size(); at + 12 <= file.size() && chunks.size() < max_chunks;) {
        const uint32_t size = swap_ends(get<uint32_t>(file, at));
        chunks.push_back({ get<std::array<char, 4>>(file, at + 4), cut(file, at + 8, size) });
        at += 12 + chunks.back().bytes.size();
    }
    return chunks;
}

File join_chunks(const std::vector<Chunk>& chunks)
{
    File file(signature.begin(), signature.end());
    for (const Chunk& chunk : chunks) {
        append(file, swap_ends(uint32_t(chunk.bytes.size())));
        const size_t start = file.size();
        append(file, chunk.kind);
        file.insert(file.end(), chunk.bytes.begin(), chunk.bytes.end());
        append(file, swap_ends(uint32_t(crc32(0, file.data() + start, uInt(file.size() - start)))));
    }
    return file;
}

void mutate_chunk(std::vector<Chunk>& chunks, size_t limit, Random& random)
{
    Chunk& chunk = chunks[pick(random, chunks.size())];
    const bool is_packed = chunk.kind == std::array { 'I', 'D', 'A', 'T' };
    switch (pick(random, 8)) {
    case 0:
        std::swap(chunk, chunks[pick(random, chunks.size())]);
        break;
    case 1:
        if (chunks.size() < max_chunks)
            chunks.insert(chunks.begin() + ptrdiff_t(pick(random, chunks.size() + 1)), Chunk(chunk));
        break;
    case 2: {
        constexpr const char* kinds[] { "PLTE", "tRNS", "IDAT", "IEND", "IHDR", "CgBI", "gAMA", "tEXt" };
        std::copy_n(kinds[pick(random, std::size(kinds))], 4, chunk.kind.begin());
        break;
    }
    default:
        if (is_packed && pick(random, 4) != 0)
            chunk.bytes = pack(mutate_bytes(unpack(chunk.bytes, max_raw), max_raw, random));
        else if (pick(random, 2) == 0)
            mutate_field(chunk.bytes, 0, chunk.bytes.size(), random);
        else
            chunk.bytes = mutate_bytes(std::move(chunk.bytes), limit, random);
        break;
    }
}

} // namespace

File mutate_png(const File& file, size_t limit, Random& random)
{
    std::vector<Chunk> chunks;
    if (get<std::array<uint8_t, 8>>(file, 0) == signature)
        chunks = take_chunks(file);
    if (chunks.empty() || pick(random, 10) == 0)
        return mutate_bytes(file, limit, random);
    for (size_t changes = 1 + pick(random, 3); changes > 0; changes--)
        mutate_chunk(chunks, limit, random);
    File result = join_chunks(chunks);
    result.resize(std::min(result.size(), limit));
    return result;
}

} // namespace vkpt::fuzz
