// SPDX-License-Identifier: GPL-2.0-or-later
// The sound of a recorded demo, laid beside the frames of its trace.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vkpt::trace {
class TraceReader;
}

namespace vkpt::client {

// A stretch of the recorded sound, in samples of each channel.
struct SoundPiece {
    int64_t first = 0; // in the recording; silence: -1
    int64_t count = 0;

    bool operator==(const SoundPiece&) const = default;
};

// A recorded frame: when the trace shows it, and what was heard by then.
struct SoundMark {
    double seconds = 0;
    int64_t position = 0; // samples
};

// What is heard in `seconds` of the trace's time from `from` on. Two clocks meet here: the engine's time of a view may
// be some milliseconds before or behind the time of its sound, which is heard on without a break; but where they part
// by more (a map was loaded in between), the sound is cut so that it goes with the picture again. `end`: samples in the
// recording. `marks`: at least one, in order.
std::vector<SoundPiece> plan_sound(
    const std::vector<SoundMark>& marks, int64_t end, uint32_t rate, double from, double seconds);
inline constexpr double max_sound_lag = 0.02; // seconds

// Writes that stretch of a file of recording_sound.so as a WAV file. Returns why there is none: the engine had no
// sound, or nothing is heard; "": it is written. Throws Failure where it cannot be written or is too long for a WAV
// file (six hours).
std::string write_sound(const std::filesystem::path& recorded, const trace::TraceReader& trace, double from,
    double seconds, const std::filesystem::path& wav);

} // namespace vkpt::client
