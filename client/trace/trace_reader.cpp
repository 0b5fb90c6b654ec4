// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/trace/trace_reader.hpp"

#include "client/trace/call_codec.hpp"
#include "client/trace/view_codec.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace vkpt::trace {

namespace {

// No chunk of ours comes near: a frame's calls end it.
constexpr uint32_t max_raw_bytes = 1u << 28;
// Deflate's best.
constexpr uint64_t max_ratio = 1040;

} // namespace

bool is_lasting(CallKind kind)
{
    return kind == CallKind::setting || kind == CallKind::set_palette
        || (kind >= CallKind::begin_registration && kind <= CallKind::end_registration);
}

TraceReader::TraceReader(const std::filesystem::path& path)
    : path_(path)
{
    errno = 0;
    file_.open(path, std::ios::binary | std::ios::ate);
    if (!file_)
        throw std::system_error(errno, std::generic_category(), "cannot read " + path.string());
    file_bytes_ = uint64_t(file_.tellg());
    read_header();
    index_chunks();
}

void TraceReader::fail(uint64_t offset, const std::string& reason) const
{
    throw formats::FormatError(path_.string(), offset, reason);
}

void TraceReader::read_header()
{
    FileHeader header;
    file_.seekg(0);
    file_.read(reinterpret_cast<char*>(&header), sizeof header);
    if (!file_ || header.magic != file_magic)
        fail(0, "this is no trace; `vkpt record` makes one from a demo");
    if (header.crc != header_crc(header))
        fail(0, "the header is damaged");
    if (header.version > file_version)
        fail(8,
            "the trace has version " + std::to_string(header.version) + ", this program reads up to "
                + std::to_string(file_version) + ": use a newer vkpt, or record it anew");
}

// False: the file ends before the chunk does.
bool TraceReader::read_chunk_header(uint64_t offset, ChunkHeader& header)
{
    if (file_bytes_ - offset < sizeof header)
        return false;
    file_.clear();
    file_.seekg(std::streamoff(offset));
    file_.read(reinterpret_cast<char*>(&header), sizeof header);
    if (!file_ || header.crc != header_crc(header))
        fail(offset, "the file is damaged here; record it anew");
    if (header.raw_bytes > max_raw_bytes || header.raw_bytes > max_ratio * (uint64_t(header.packed_bytes) + 1))
        fail(offset, "a chunk of impossible size");
    return file_bytes_ - offset - sizeof header >= header.packed_bytes;
}

std::vector<std::byte> TraceReader::read_payload(const Chunk& chunk)
{
    std::vector<std::byte> packed(chunk.header.packed_bytes), raw(chunk.header.raw_bytes);
    file_.clear();
    file_.seekg(std::streamoff(chunk.offset + sizeof(ChunkHeader)));
    file_.read(reinterpret_cast<char*>(packed.data()), std::streamsize(packed.size()));
    uLongf size = uLong(raw.size());
    if (!file_ || crc_of(packed) != chunk.header.payload_crc
        || uncompress(reinterpret_cast<Bytef*>(raw.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
               uLong(packed.size()))
            != Z_OK
        || size != raw.size())
        fail(chunk.offset, "the file is damaged here; record it anew");
    return raw;
}

// The chunk's frames; on_call(call, number of the frame in the chunk, inside) sees every call.
template <class OnCall> std::vector<Frame> TraceReader::decode(const Chunk& chunk, OnCall on_call)
{
    const std::vector<std::byte> raw = read_payload(chunk);
    Decoder decoder(raw, path_.string() + ", chunk at byte " + std::to_string(chunk.offset));
    CallCodec call_codec;
    ViewCodec view_codec;
    std::vector<Frame> frames;
    Frame current;
    std::vector<Call> lasting; // of the current frame: whether they stand inside a shown one is known at its end
    bool is_open = false;
    const auto close = [&](bool is_shown) {
        for (const Call& call : lasting)
            on_call(call, frames.size(), is_shown);
        lasting.clear();
        if (is_shown)
            frames.push_back(std::move(current));
        current = {};
    };
    while (!decoder.is_at_end()) {
        Call call;
        call_codec.code(decoder, call);
        if (call.kind == CallKind::begin_frame) {
            close(false);
            is_open = true;
        }
        if (call.kind == CallKind::render_view) {
            View view;
            view_codec.code(decoder, view);
            if (is_open)
                current.views.push_back(std::move(view));
        }
        const bool is_last = is_open && call.kind == CallKind::end_frame;
        if (is_lasting(call.kind) && is_open)
            lasting.push_back(call);
        else
            on_call(call, frames.size(), false);
        if (is_open)
            current.calls.push_back(std::move(call));
        if (is_last) {
            close(!current.views.empty());
            is_open = false;
        }
    }
    close(false);
    return frames;
}

void TraceReader::index_chunks()
{
    uint64_t offset = sizeof(FileHeader);
    while (true) {
        Chunk chunk { offset, {}, times_.size() };
        if (!read_chunk_header(offset, chunk.header)) {
            cut_at_ = offset;
            return;
        }
        offset += sizeof(ChunkHeader) + chunk.header.packed_bytes;
        if (chunk.header.tag == tag_end) {
            check_totals(chunk);
            if (offset != file_bytes_)
                fail(offset, "more follows after the end");
            return;
        }
        if (chunk.header.tag == tag_calls)
            index_chunk(chunk);
        else
            fail(chunk.offset, "a chunk of unknown kind");
    }
}

void TraceReader::index_chunk(Chunk chunk)
{
    const std::vector<Frame> frames = decode(chunk, [&](const Call& call, size_t frame, bool is_inside) {
        totals_.calls++;
        totals_.frames += call.kind == CallKind::end_frame;
        totals_.views += call.kind == CallKind::render_view;
        note(call, chunk.first_frame + frame, is_inside);
    });
    for (const Frame& frame : frames)
        times_.push_back(frame.views.front().refdef.time);
    if (!frames.empty())
        chunks_.push_back(chunk);
}

void TraceReader::note(const Call& call, size_t frame, bool is_inside)
{
    if (is_lasting(call.kind))
        lasting_calls_.push_back({ frame, is_inside, call });
    if (call.kind == CallKind::fact || call.kind == CallKind::file || call.kind == CallKind::screen)
        facts_.push_back(call);
}

void TraceReader::check_totals(const Chunk& chunk)
{
    const std::vector<std::byte> raw = read_payload(chunk);
    TraceTotals written;
    if (raw.size() != sizeof written)
        fail(chunk.offset, "the end is damaged; record it anew");
    std::memcpy(&written, raw.data(), sizeof written);
    if (written.calls != totals_.calls || written.frames != totals_.frames || written.views != totals_.views)
        fail(chunk.offset, "calls are missing; record it anew");
}

uint32_t count_views(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    file.seekg(sizeof(FileHeader));
    uint32_t views = 0;
    ChunkHeader header;
    while (file.read(reinterpret_cast<char*>(&header), sizeof header) && header.crc == header_crc(header)) {
        views += header.views;
        file.seekg(header.packed_bytes, std::ios::cur);
    }
    return views;
}

double TraceReader::seconds(size_t frame) const
{
    double sum = 0;
    for (size_t i = 1; i <= frame; i++)
        sum += std::max(double(times_[i]) - double(times_[i - 1]), 0.0);
    return sum;
}

const Frame& TraceReader::frame(size_t number)
{
    const auto after = std::ranges::upper_bound(chunks_, number, {}, &Chunk::first_frame);
    const size_t place = size_t(after - chunks_.begin()) - 1;
    if (place != decoded_chunk_) {
        decoded_ = decode(chunks_[place], [](const Call&, size_t, bool) {});
        decoded_chunk_ = place;
    }
    return decoded_[number - chunks_[place].first_frame];
}

} // namespace vkpt::trace
