// SPDX-License-Identifier: GPL-2.0-or-later
#include "common/trace/file_format.hpp"
#include "fuzz/support/packed.hpp"
#include "fuzz/support/records.hpp"

#include <algorithm>

namespace vkpt::fuzz {

namespace {

using namespace vkpt::trace;

constexpr size_t max_raw = 1 << 16, max_chunks = 64;

struct TraceChunk {
    ChunkHeader header;
    File raw;
};

std::vector<TraceChunk> take_chunks(const File& file)
{
    std::vector<TraceChunk> chunks;
    for (size_t at = sizeof(FileHeader); at + sizeof(ChunkHeader) <= file.size() && chunks.size() < max_chunks;) {
        const auto header = get<ChunkHeader>(file, at);
        const File packed = cut(file, at + sizeof header, header.packed_bytes);
        chunks.push_back({ header, unpack(packed, max_raw) });
        at += sizeof header + packed.size();
    }
    return chunks;
}

File join_chunks(FileHeader start, const std::vector<TraceChunk>& chunks)
{
    File file;
    start.crc = header_crc(start);
    append(file, start);
    for (const TraceChunk& chunk : chunks) {
        const File packed = pack(chunk.raw);
        ChunkHeader header = chunk.header;
        header.packed_bytes = uint32_t(packed.size());
        header.raw_bytes = uint32_t(chunk.raw.size());
        header.payload_crc = crc_of(packed);
        header.crc = header_crc(header);
        append(file, header);
        file.insert(file.end(), packed.begin(), packed.end());
    }
    return file;
}

// Calls are bytes without marks between them: pieces are copied, left out and moved, and numbers changed.
void mutate_raw(File& raw, Random& random)
{
    if (raw.empty() || pick(random, 2) == 0) {
        raw = mutate_bytes(std::move(raw), max_raw, random);
        return;
    }
    const size_t from = pick(random, raw.size()), count = 1 + pick(random, std::min<size_t>(raw.size() - from, 64));
    const auto first = raw.begin() + ptrdiff_t(from);
    switch (pick(random, 3)) {
    case 0: {
        const File piece(first, first + ptrdiff_t(count));
        if (raw.size() + count <= max_raw)
            raw.insert(raw.begin() + ptrdiff_t(pick(random, raw.size() + 1)), piece.begin(), piece.end());
        break;
    }
    case 1:
        raw.erase(first, first + ptrdiff_t(count));
        break;
    default:
        mutate_field(raw, from, std::min<size_t>(raw.size() - from, 8), random);
        break;
    }
}

void mutate_chunk(std::vector<TraceChunk>& chunks, Random& random)
{
    TraceChunk& chunk = chunks[pick(random, chunks.size())];
    switch (pick(random, 12)) {
    case 0:
        std::swap(chunk, chunks[pick(random, chunks.size())]);
        break;
    case 1:
        if (chunks.size() < max_chunks)
            chunks.insert(chunks.begin() + ptrdiff_t(pick(random, chunks.size() + 1)), TraceChunk(chunk));
        break;
    case 2:
        chunk.header.views = uint32_t(random());
        break;
    default:
        mutate_raw(chunk.raw, random);
        break;
    }
}

} // namespace

File mutate_trace(const File& file, size_t limit, Random& random)
{
    const auto start = get<FileHeader>(file, 0);
    std::vector<TraceChunk> chunks;
    if (start.magic == file_magic)
        chunks = take_chunks(file);
    if (chunks.empty() || pick(random, 10) == 0)
        return mutate_bytes(file, limit, random);
    for (size_t changes = 1 + pick(random, 4); changes > 0; changes--)
        mutate_chunk(chunks, random);
    // Totals that no longer fit would refuse every change: without its end a trace counts as cut off.
    if (chunks.size() > 1 && chunks.back().header.tag == tag_end && pick(random, 4) != 0)
        chunks.pop_back();
    File result = join_chunks(start, chunks);
    if (pick(random, 20) == 0) // a chunk's header that does not fit what follows
        mutate_field(result, sizeof(FileHeader), sizeof(ChunkHeader), random);
    result.resize(std::min(result.size(), limit));
    return result;
}

} // namespace vkpt::fuzz
