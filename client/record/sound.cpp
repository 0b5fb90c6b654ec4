// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/record/sound.hpp"

#include "client/host/errors.hpp"
#include "client/host/output_file.hpp"
#include "client/record/sound_file.hpp"
#include "common/trace/trace_reader.hpp"
#include "formats/wav.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>

namespace vkpt::client {

namespace fs = std::filesystem;

namespace {

constexpr const char* no_device = "the engine opened no sound device";
constexpr const char* all_silent = "nothing is heard in this part, or the game's sounds are not installed";

class Planner {
public:
    Planner(int64_t end, uint32_t rate)
        : end_(end)
        , rate_(rate)
    {
    }

    int64_t samples(double seconds) const { return std::llround(seconds * rate_); }
    int64_t position() const { return position_; }
    void jump(int64_t position) { position_ = std::max<int64_t>(position, 0); }

    // What comes next in the recording; behind its end there is silence.
    void hear(int64_t count)
    {
        const int64_t heard = std::clamp<int64_t>(end_ - position_, 0, count);
        add(position_, heard);
        add(-1, count - heard);
        position_ += count;
    }
    std::vector<SoundPiece> take() { return std::move(pieces_); }

private:
    void add(int64_t first, int64_t count)
    {
        if (count == 0)
            return;
        if (!pieces_.empty()) {
            SoundPiece& last = pieces_.back();
            if (first < 0 ? last.first < 0 : last.first >= 0 && last.first + last.count == first) {
                last.count += count;
                return;
            }
        }
        pieces_.push_back({ first, count });
    }

    int64_t end_, position_ = 0;
    double rate_;
    std::vector<SoundPiece> pieces_;
};

std::vector<SoundMark> read_marks(const fs::path& path, const trace::TraceReader& trace)
{
    std::ifstream file(path, std::ios::binary);
    std::vector<SoundMark> marks;
    int64_t position = 0;
    while (marks.size() < trace.frame_count() && file.read(reinterpret_cast<char*>(&position), sizeof position))
        marks.push_back({ trace.seconds(marks.size()), position });
    return marks;
}

// True: some of it is not silent.
bool copy_samples(std::ifstream& from, int64_t bytes, OutputFile& to)
{
    constexpr int64_t block_bytes = 1 << 20;
    std::vector<std::byte> block;
    bool is_heard = false;
    for (int64_t left = bytes; left > 0; left -= int64_t(block.size())) {
        block.assign(size_t(std::min(left, block_bytes)), std::byte { 0 });
        from.read(reinterpret_cast<char*>(block.data()), std::streamsize(block.size()));
        is_heard |= std::ranges::any_of(block, [](std::byte byte) { return byte != std::byte { 0 }; });
        to.write(block);
    }
    return is_heard;
}

void write_silence(int64_t bytes, OutputFile& to)
{
    const std::vector<std::byte> block(1 << 16, std::byte { 0 });
    for (int64_t left = bytes; left > 0; left -= int64_t(block.size()))
        to.write(formats::Bytes(block).first(size_t(std::min(left, int64_t(block.size())))));
}

} // namespace

std::vector<SoundPiece> plan_sound(
    const std::vector<SoundMark>& marks, int64_t end, uint32_t rate, double from, double seconds)
{
    Planner planner(end, rate);
    const auto is_later = [](double time, const SoundMark& mark) { return time < mark.seconds; };
    auto next = std::upper_bound(marks.begin(), marks.end(), from, is_later);
    const SoundMark& shown = next == marks.begin() ? *next : *(next - 1);
    planner.jump(shown.position + planner.samples(from - shown.seconds));
    const int64_t length = planner.samples(seconds);
    int64_t done = 0;
    for (; next != marks.end(); ++next) {
        const int64_t at = planner.samples(next->seconds - from);
        if (at >= length)
            break;
        planner.hear(at - done);
        done = at;
        if (std::abs(planner.position() - next->position) > planner.samples(max_sound_lag))
            planner.jump(next->position);
    }
    planner.hear(length - done);
    return planner.take();
}

std::string write_sound(
    const fs::path& recorded, const trace::TraceReader& trace, double from, double seconds, const fs::path& wav)
{
    std::ifstream samples(recorded, std::ios::binary);
    SoundFileHeader header;
    samples.read(reinterpret_cast<char*>(&header), sizeof header);
    const std::vector<SoundMark> marks = read_marks(recorded.string() + sound_views_ending, trace);
    if (!samples || marks.empty())
        return no_device;
    const int64_t moment = int64_t(header.channels) * header.bits / 8;
    const int64_t end = (int64_t(fs::file_size(recorded)) - int64_t(sizeof header)) / moment;
    const std::vector<SoundPiece> pieces = plan_sound(marks, end, header.rate, from, seconds);
    int64_t count = 0;
    for (const SoundPiece& piece : pieces)
        count += piece.count;
    if (count > formats::max_wav_bytes / moment)
        throw Failure(fmt::format("{:.0f} seconds of sound are too long for a WAV file", seconds));
    OutputFile file(wav);
    file.write(formats::make_wav_header({ header.channels, header.rate, header.bits }, uint32_t(count * moment)));
    bool is_heard = false;
    for (const SoundPiece& piece : pieces) {
        if (piece.first < 0) {
            write_silence(piece.count * moment, file);
            continue;
        }
        samples.seekg(int64_t(sizeof header) + piece.first * moment);
        is_heard |= copy_samples(samples, piece.count * moment, file);
    }
    if (!is_heard)
        return all_silent;
    file.commit();
    return "";
}

} // namespace vkpt::client
