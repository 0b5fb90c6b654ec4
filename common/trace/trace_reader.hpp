// SPDX-License-Identifier: GPL-2.0-or-later
// Reads a trace: all of it once when it is opened, to know that it is sound and where each frame lies; then any frame.
#pragma once

#include "common/trace/calls.hpp"
#include "common/trace/file_format.hpp"

#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>
#include <vector>

namespace vkpt::trace {

// One frame with a 3D view: its calls from begin_frame to end_frame. Frames of 2D alone (loading, films) are read over.
struct Frame {
    std::vector<Call> calls;
    std::vector<View> views; // of the render_view calls, in order
};

// A call that counts for later frames, too: what is registered, and settings.
struct LastingCall {
    size_t frame; // the first that it counts for
    bool is_inside; // it stands among that frame's own calls
    Call call;
};
bool is_lasting(CallKind kind);

class TraceReader {
public:
    // Throws FormatError for what is no trace, damaged, of a newer version or more than a recorder writes;
    // std::system_error where it cannot be read. A file that ends too early is read up to there.
    explicit TraceReader(const std::filesystem::path& path);
    // A trace in memory; `name` is for messages.
    TraceReader(std::string bytes, const std::string& name);

    size_t frame_count() const { return times_.size(); }
    // Engine's clock of the frame's first view, in seconds.
    float time(size_t frame) const { return times_[frame]; }
    // Since the first frame. The engine's clock starts anew with a map: what that took is not known and does not count.
    double seconds(size_t frame) const { return seconds_[frame]; }
    // The last frame that is not later.
    size_t frame_at(double seconds) const;
    const Frame& frame(size_t number); // valid until the next call

    // All of them in order.
    const std::vector<LastingCall>& lasting_calls() const { return lasting_calls_; }
    // In one view, of all frames.
    struct Most {
        size_t entities = 0, dlights = 0, particles = 0;
    };
    const Most& most() const { return max_; }
    // How it was recorded, and the files that were loaded.
    const std::vector<Call>& facts() const { return facts_; }
    const TraceTotals& totals() const { return totals_; }
    // Where the file was cut off; 0: it is whole.
    uint64_t cut_at() const { return cut_at_; }
    uint64_t file_bytes() const { return file_bytes_; }

private:
    struct Chunk {
        uint64_t offset;
        ChunkHeader header;
        size_t first_frame;
    };
    void read_all();
    void read_header();
    bool read_chunk_header(uint64_t offset, ChunkHeader& header);
    std::vector<std::byte> read_payload(const Chunk& chunk);
    enum class FrameCalls { all, lasting };
    template <class OnCall, class OnFrame>
    uint64_t decode(const Chunk& chunk, FrameCalls kept, OnCall on_call, OnFrame on_frame);
    void index_chunks();
    void index_chunk(const Chunk& chunk);
    void index_frame(const Frame& frame);
    void check_totals(const Chunk& chunk);
    void note(const Call& call, size_t frame, bool is_inside);
    [[noreturn]] void fail(uint64_t offset, const std::string& reason) const;

    std::filesystem::path path_;
    std::unique_ptr<std::istream> file_;
    uint64_t file_bytes_ = 0, cut_at_ = 0;
    std::vector<Chunk> chunks_;
    std::vector<float> times_;
    std::vector<double> seconds_;
    Most max_;
    std::vector<LastingCall> lasting_calls_;
    std::vector<Call> facts_;
    TraceTotals totals_;
    uint64_t unpacked_ = 0, memory_ = 0, kept_ = 0; // of the chunks so far, in bytes

    size_t decoded_chunk_ = SIZE_MAX;
    std::vector<Frame> decoded_;
};

// Views in the whole chunks so far of a file that is being written.
uint32_t count_views(const std::filesystem::path& path);

} // namespace vkpt::trace
