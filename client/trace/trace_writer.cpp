// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/trace/trace_writer.hpp"

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace vkpt::trace {

namespace {

// A chunk ends with the frame that reaches one of these: what a crash may cost, and what a reader holds in memory.
constexpr uint32_t views_per_chunk = 64;
constexpr size_t bytes_per_chunk = 1 << 20;
constexpr int compression_level = 9;

[[noreturn]] void fail(const std::filesystem::path& path)
{
    throw std::system_error(errno, std::generic_category(), "cannot write " + path.string());
}

} // namespace

TraceWriter::TraceWriter(const std::filesystem::path& path)
    : path_(path)
    , file_(std::fopen(path.c_str(), "wb"), std::fclose)
    , coding_(std::make_unique<Coding>())
{
    if (!file_)
        fail(path);
    FileHeader header;
    header.crc = header_crc(header);
    write_bytes(std::as_bytes(std::span(&header, 1)));
    if (std::fflush(file_.get()) != 0)
        fail(path_);
}

TraceWriter::~TraceWriter() = default;

void TraceWriter::count(CallKind kind)
{
    totals_.calls++;
    totals_.frames += kind == CallKind::end_frame;
    totals_.views += kind == CallKind::render_view;
}

void TraceWriter::write(Call call)
{
    coding_->calls.code(coding_->bytes, call);
    count(call.kind);
    if (call.kind == CallKind::end_frame
        && (coding_->view_count >= views_per_chunk || coding_->bytes.size() >= bytes_per_chunk))
        write_chunk();
}

void TraceWriter::write(View& view)
{
    Call call;
    call.kind = CallKind::render_view;
    coding_->calls.code(coding_->bytes, call);
    coding_->views.code(coding_->bytes, view);
    coding_->view_count++;
    count(call.kind);
}

void TraceWriter::finish()
{
    write_chunk();
    write_packed(tag_end, std::as_bytes(std::span(&totals_, 1)), 0);
    std::FILE* file = file_.release();
    if (std::fclose(file) != 0) // a full disk may show only here
        fail(path_);
}

void TraceWriter::write_chunk()
{
    const uint32_t views = coding_->view_count;
    const std::vector<std::byte> raw = coding_->bytes.take();
    coding_ = std::make_unique<Coding>();
    if (raw.empty())
        return;
    write_packed(tag_calls, raw, views);
    if (std::fflush(file_.get()) != 0)
        fail(path_);
}

void TraceWriter::write_packed(uint32_t tag, std::span<const std::byte> raw, uint32_t views)
{
    uLongf size = compressBound(uLong(raw.size()));
    std::vector<std::byte> packed(size);
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
            uLong(raw.size()), compression_level)
        != Z_OK)
        throw std::bad_alloc(); // the only way for it to fail
    packed.resize(size);
    ChunkHeader header { tag, uint32_t(packed.size()), uint32_t(raw.size()), views, crc_of(packed), 0 };
    header.crc = header_crc(header);
    write_bytes(std::as_bytes(std::span(&header, 1)));
    write_bytes(packed);
}

void TraceWriter::write_bytes(std::span<const std::byte> bytes)
{
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
        fail(path_);
    bytes_written_ += bytes.size();
}

} // namespace vkpt::trace
