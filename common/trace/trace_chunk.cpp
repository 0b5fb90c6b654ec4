// SPDX-License-Identifier: GPL-2.0-or-later
#include "common/trace/trace_chunk.hpp"

#include <cstring>
#include <new>

namespace vkpt::trace {

namespace {

// A chunk ends with the frame that reaches one of these: what a crash may cost, and what a reader holds in memory.
constexpr uint32_t views_per_chunk = 64;
constexpr size_t bytes_per_chunk = 1 << 20;

} // namespace

std::vector<std::byte> make_header()
{
    FileHeader header;
    header.crc = header_crc(header);
    const auto bytes = std::as_bytes(std::span(&header, 1));
    return { bytes.begin(), bytes.end() };
}

std::vector<std::byte> pack_chunk(uint32_t tag, std::span<const std::byte> raw, uint32_t views, int level)
{
    uLongf size = compressBound(uLong(raw.size()));
    std::vector<std::byte> chunk(sizeof(ChunkHeader) + size);
    std::byte* const packed = chunk.data() + sizeof(ChunkHeader);
    if (compress2(reinterpret_cast<Bytef*>(packed), &size, reinterpret_cast<const Bytef*>(raw.data()),
            uLong(raw.size()), level)
        != Z_OK)
        throw std::bad_alloc(); // the only way for it to fail
    chunk.resize(sizeof(ChunkHeader) + size);
    ChunkHeader header { tag, uint32_t(size), uint32_t(raw.size()), views, crc_of(std::span(packed, size)), 0 };
    header.crc = header_crc(header);
    std::memcpy(chunk.data(), &header, sizeof header);
    return chunk;
}

void ChunkWriter::write(Call& call) { coding_->calls.code(coding_->bytes, call); }

void ChunkWriter::write(View& view)
{
    Call call;
    call.kind = CallKind::render_view;
    write(call);
    coding_->views.code(coding_->bytes, view);
    coding_->view_count++;
}

bool ChunkWriter::is_full() const
{
    return coding_->view_count >= views_per_chunk || coding_->bytes.size() >= bytes_per_chunk;
}

std::vector<std::byte> ChunkWriter::take(int level)
{
    const uint32_t views = coding_->view_count;
    const std::vector<std::byte> raw = coding_->bytes.take();
    coding_ = std::make_unique<Coding>();
    return raw.empty() ? std::vector<std::byte>() : pack_chunk(tag_calls, raw, views, level);
}

} // namespace vkpt::trace
