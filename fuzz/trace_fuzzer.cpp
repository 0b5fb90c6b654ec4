// SPDX-License-Identifier: GPL-2.0-or-later
// A recorded game: opened, every frame read, forwards and backwards, as replay and viewer do.
#include "common/trace/trace_reader.hpp"
#include "fuzz/support/harness.hpp"

#include <string>
#include <sys/mman.h>
#include <unistd.h>

namespace {

using namespace vkpt;

// The reader wants a path: this one is in memory alone.
class MemoryFile {
public:
    MemoryFile()
        : file_(memfd_create("trace", 0))
        , path_("/proc/self/fd/" + std::to_string(file_))
    {
        fuzz::require(file_ >= 0, "the system makes files in memory");
    }

    const std::string& hold(const uint8_t* data, size_t size) const
    {
        const bool is_held = ftruncate(file_, 0) == 0 && pwrite(file_, data, size, 0) == ssize_t(size);
        fuzz::require(is_held, "the system holds an input in memory");
        return path_;
    }

private:
    int file_;
    std::string path_;
};

void read_frames(trace::TraceReader& reader)
{
    const size_t count = reader.frame_count();
    for (size_t i = 0; i < count; i++) {
        const trace::Frame& frame = reader.frame(i);
        fuzz::require(!frame.views.empty(), "every frame of a trace has a view");
        fuzz::use(reader.time(i));
    }
    for (size_t i = 0; i < std::min<size_t>(count, 4); i++)
        fuzz::use(reader.frame(count - 1 - i));
    if (count > 0)
        fuzz::use(reader.seconds(count - 1));
    for (const trace::LastingCall& call : reader.lasting_calls())
        fuzz::require(trace::is_lasting(call.call.kind), "lasting calls last");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    static const MemoryFile file;
    try {
        trace::TraceReader reader(file.hold(data, size));
        read_frames(reader);
    } catch (const formats::FormatError&) {
    }
    return 0;
}
