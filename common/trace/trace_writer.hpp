// SPDX-License-Identifier: GPL-2.0-or-later
// Writes a trace call by call, in constant memory. What has been written when the process dies can be played.
#pragma once

#include "common/trace/trace_chunk.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace vkpt::trace {

class TraceWriter {
public:
    // Throws std::system_error, as all that writes.
    explicit TraceWriter(const std::filesystem::path& path);
    ~TraceWriter(); // without finish(): the file stays cut off after the last whole chunk
    TraceWriter(const TraceWriter&) = delete;
    TraceWriter& operator=(const TraceWriter&) = delete;

    void write(Call call); // any but render_view
    void write(View& view); // render_view
    void finish();

    const TraceTotals& totals() const { return totals_; }
    uint64_t bytes_written() const { return bytes_written_; }

private:
    void write_chunk();
    void write_bytes(std::span<const std::byte> bytes);

    std::filesystem::path path_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
    ChunkWriter chunk_;
    TraceTotals totals_;
    uint64_t bytes_written_ = 0;
};

} // namespace vkpt::trace
