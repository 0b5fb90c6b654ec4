// SPDX-License-Identifier: GPL-2.0-or-later
#include "common/trace/trace_reader.hpp"

#include "common/trace/call_codec.hpp"
#include "common/trace/view_codec.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

namespace vkpt::trace {

namespace {

// What no recorder comes near, so that a small file cannot take a machine's memory and time. A chunk ends with the
// frame that brings it to 1 MiB or 64 views; the largest frames are films and consoles that fill a large window.
constexpr uint32_t max_chunk_bytes = 32u << 20; // unpacked
constexpr uint64_t max_chunk_memory = 128ull << 20; // as calls and views
constexpr uint64_t max_kept_memory = 64ull << 20; // of what is kept of all chunks: what lasts, and facts
// By the size of the file; 1 MiB for smaller ones.
constexpr uint64_t max_unpacked_ratio = 128, max_memory_ratio = 1024;
// Deflate's best.
constexpr uint64_t max_ratio = 1040;

uint64_t memory_of(const Call& call) { return sizeof call + call.name.size() + call.text.size() + call.data.size(); }

uint64_t memory_of(const View& view)
{
    return sizeof view + view.entities.size() * sizeof view.entities[0] + view.dlights.size() * sizeof view.dlights[0]
        + view.particles.size() * sizeof view.particles[0];
}

bool is_recorded(const std::string& setting)
{
    return std::ranges::any_of(recorded_settings, [&](const RecordedSetting& s) { return setting == s.name; });
}

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
    auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
    if (!*file)
        throw std::system_error(errno, std::generic_category(), "cannot read " + path.string());
    file_ = std::move(file);
    read_all();
}

TraceReader::TraceReader(std::string bytes, const std::string& name)
    : path_(name)
    , file_(std::make_unique<std::istringstream>(std::move(bytes)))
{
    read_all();
}

void TraceReader::read_all()
{
    file_->seekg(0, std::ios::end);
    file_bytes_ = uint64_t(file_->tellg());
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
    file_->seekg(0);
    file_->read(reinterpret_cast<char*>(&header), sizeof header);
    if (!*file_ || header.magic != file_magic)
        fail(0, "not a trace; `vkpt record` makes one from a demo");
    if (header.crc != header_crc(header))
        fail(0, "the header is damaged");
    if (header.version > file_version)
        fail(8,
            "the trace has version " + std::to_string(header.version) + ", this program reads up to "
                + std::to_string(file_version) + ": use a newer vkpt, or record it again");
}

// False: the file ends before the chunk does.
bool TraceReader::read_chunk_header(uint64_t offset, ChunkHeader& header)
{
    if (file_bytes_ - offset < sizeof header)
        return false;
    file_->clear();
    file_->seekg(std::streamoff(offset));
    file_->read(reinterpret_cast<char*>(&header), sizeof header);
    if (!*file_ || header.crc != header_crc(header))
        fail(offset, "the file is damaged here; record it again");
    if (header.raw_bytes > max_chunk_bytes || header.raw_bytes > max_ratio * (uint64_t(header.packed_bytes) + 1)
        || header.packed_bytes > compressBound(header.raw_bytes))
        fail(offset, "a chunk of impossible size");
    return file_bytes_ - offset - sizeof header >= header.packed_bytes;
}

std::vector<std::byte> TraceReader::read_payload(const Chunk& chunk)
{
    std::vector<std::byte> packed(chunk.header.packed_bytes), raw(chunk.header.raw_bytes);
    file_->clear();
    file_->seekg(std::streamoff(chunk.offset + sizeof(ChunkHeader)));
    file_->read(reinterpret_cast<char*>(packed.data()), std::streamsize(packed.size()));
    uLongf size = uLong(raw.size());
    if (!*file_ || crc_of(packed) != chunk.header.payload_crc
        || uncompress(reinterpret_cast<Bytef*>(raw.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
               uLong(packed.size()))
            != Z_OK
        || size != raw.size())
        fail(chunk.offset, "the file is damaged here; record it again");
    return raw;
}

// on_call(call, number of the frame in the chunk, inside) sees every call, on_frame(frame) every shown frame after
// them, with all of its calls or with those alone that last. What all of it takes in memory, if all are kept.
template <class OnCall, class OnFrame>
uint64_t TraceReader::decode(const Chunk& chunk, FrameCalls kept, OnCall on_call, OnFrame on_frame)
{
    const std::vector<std::byte> raw = read_payload(chunk);
    Decoder decoder(raw, path_.string() + ", chunk at byte " + std::to_string(chunk.offset));
    CallCodec call_codec;
    ViewCodec view_codec;
    Frame current;
    std::vector<size_t> lasting; // of the current frame: whether they stand inside a shown one is known at its end
    size_t frames = 0;
    bool is_open = false;
    uint64_t memory = 0;
    const auto count = [&](uint64_t bytes) {
        memory += bytes;
        decoder.check(memory <= max_chunk_memory, "no recorder writes a chunk that takes so much memory");
    };
    const auto close = [&](bool is_shown) {
        for (const size_t call : lasting)
            on_call(current.calls[call], frames, is_shown);
        lasting.clear();
        if (is_shown) {
            on_frame(std::move(current));
            frames++;
        }
        current = {};
    };
    while (!decoder.is_at_end()) {
        Call call;
        call_codec.code(decoder, call);
        count(memory_of(call));
        if (call.kind == CallKind::setting)
            decoder.check(is_recorded(call.name), "a setting that no recorder writes; record it again");
        if (call.kind == CallKind::begin_frame) {
            close(false);
            is_open = true;
        }
        if (call.kind == CallKind::render_view) {
            View skipped;
            View& view = is_open ? current.views.emplace_back() : skipped;
            view_codec.code(decoder, view);
            count(memory_of(view));
        }
        const bool is_last = is_open && call.kind == CallKind::end_frame;
        const bool lasts = is_lasting(call.kind) && is_open;
        if (lasts)
            lasting.push_back(current.calls.size());
        else
            on_call(call, frames, false);
        if (lasts || (is_open && kept == FrameCalls::all))
            current.calls.push_back(std::move(call));
        if (is_last) {
            close(!current.views.empty());
            is_open = false;
        }
    }
    close(false);
    return memory;
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
                fail(offset, "there is more data after the end");
            return;
        }
        if (chunk.header.tag == tag_calls)
            index_chunk(chunk);
        else
            fail(chunk.offset, "a chunk of an unknown type");
    }
}

void TraceReader::index_chunk(const Chunk& chunk)
{
    const uint64_t size = std::max<uint64_t>(file_bytes_, 1 << 20);
    unpacked_ += chunk.header.raw_bytes;
    if (unpacked_ > max_unpacked_ratio * size)
        fail(chunk.offset, "it decompresses to more than " + std::to_string(max_unpacked_ratio) + " times its size");
    memory_ += decode(
        chunk, FrameCalls::lasting,
        [&](const Call& call, size_t frame, bool is_inside) {
            totals_.count(call.kind);
            note(call, chunk.first_frame + frame, is_inside);
            if (kept_ > max_kept_memory)
                fail(chunk.offset, "more registrations, settings and facts than any recorder writes");
        },
        [&](const Frame& frame) { index_frame(frame); });
    if (memory_ > max_memory_ratio * size)
        fail(chunk.offset, "it has more calls than any recorder fits into its size");
    if (times_.size() > chunk.first_frame)
        chunks_.push_back(chunk);
}

void TraceReader::index_frame(const Frame& frame)
{
    const float time = frame.views.front().refdef.time;
    const double passed = times_.empty() ? 0 : double(time) - double(times_.back());
    seconds_.push_back((seconds_.empty() ? 0 : seconds_.back()) + (passed > 0 ? passed : 0)); // no NaN
    times_.push_back(time);
    for (const View& view : frame.views) {
        max_.entities = std::max(max_.entities, view.entities.size());
        max_.dlights = std::max(max_.dlights, view.dlights.size());
        max_.particles = std::max(max_.particles, view.particles.size());
    }
}

void TraceReader::note(const Call& call, size_t frame, bool is_inside)
{
    const bool is_fact = call.kind == CallKind::fact || call.kind == CallKind::file || call.kind == CallKind::screen;
    if (is_lasting(call.kind))
        lasting_calls_.push_back({ frame, is_inside, call });
    if (is_fact)
        facts_.push_back(call);
    kept_ += is_fact || is_lasting(call.kind) ? memory_of(call) : 0;
}

void TraceReader::check_totals(const Chunk& chunk)
{
    const std::vector<std::byte> raw = read_payload(chunk);
    TraceTotals written;
    if (raw.size() != sizeof written)
        fail(chunk.offset, "the end is damaged; record it again");
    std::memcpy(&written, raw.data(), sizeof written);
    if (written.calls != totals_.calls || written.frames != totals_.frames || written.views != totals_.views)
        fail(chunk.offset, "calls are missing; record it again");
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

size_t TraceReader::frame_at(double seconds) const
{
    const auto after = std::ranges::upper_bound(seconds_, seconds);
    return after == seconds_.begin() ? 0 : size_t(after - seconds_.begin()) - 1;
}

const Frame& TraceReader::frame(size_t number)
{
    const auto after = std::ranges::upper_bound(chunks_, number, {}, &Chunk::first_frame);
    const size_t place = size_t(after - chunks_.begin()) - 1;
    if (place != decoded_chunk_) {
        decoded_chunk_ = SIZE_MAX;
        decoded_.clear();
        decode(
            chunks_[place], FrameCalls::all, [](const Call&, size_t, bool) {},
            [&](Frame&& frame) { decoded_.push_back(std::move(frame)); });
        decoded_chunk_ = place;
    }
    return decoded_[number - chunks_[place].first_frame];
}

} // namespace vkpt::trace
