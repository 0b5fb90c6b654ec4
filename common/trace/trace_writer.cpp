// SPDX-License-Identifier: GPL-2.0-or-later
#include "common/trace/trace_writer.hpp"

#include <cerrno>
#include <system_error>

namespace vkpt::trace {

namespace {

constexpr int compression_level = 9;

[[noreturn]] void fail(const std::filesystem::path& path)
{
    throw std::system_error(errno, std::generic_category(), "cannot write " + path.string());
}

} // namespace

TraceWriter::TraceWriter(const std::filesystem::path& path)
    : path_(path)
    , file_(std::fopen(path.c_str(), "wb"), std::fclose)
{
    if (!file_)
        fail(path);
    write_bytes(make_header());
    if (std::fflush(file_.get()) != 0)
        fail(path_);
}

TraceWriter::~TraceWriter() = default;

void TraceWriter::write(Call call)
{
    chunk_.write(call);
    totals_.count(call.kind);
    if (call.kind == CallKind::end_frame && chunk_.is_full())
        write_chunk();
}

void TraceWriter::write(View& view)
{
    chunk_.write(view);
    totals_.count(CallKind::render_view);
}

void TraceWriter::finish()
{
    write_chunk();
    write_bytes(pack_chunk(tag_end, std::as_bytes(std::span(&totals_, 1)), 0, compression_level));
    std::FILE* file = file_.release();
    if (std::fclose(file) != 0) // a full disk may show only here
        fail(path_);
}

void TraceWriter::write_chunk()
{
    const std::vector<std::byte> chunk = chunk_.take(compression_level);
    if (chunk.empty())
        return;
    write_bytes(chunk);
    if (std::fflush(file_.get()) != 0)
        fail(path_);
}

void TraceWriter::write_bytes(std::span<const std::byte> bytes)
{
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
        fail(path_);
    bytes_written_ += bytes.size();
}

} // namespace vkpt::trace
