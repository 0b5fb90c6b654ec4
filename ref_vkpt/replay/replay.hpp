// SPDX-License-Identifier: GPL-2.0-or-later
// The player of a trace in memory: forwards, backwards, at any speed, between the views that were kept.
#pragma once

#include "common/trace/trace_reader.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace vkpt {

class Replay {
public:
    // `handles`: the module's, by the trace's numbers, as long as the map is there. Throws FormatError.
    Replay(std::span<const std::byte> trace, std::vector<void*> handles);

    double length() const { return length_; } // seconds
    double place() const { return place_; } // of them
    double speed() const { return speed_; } // 1: the game's; negative: backwards
    bool is_playing() const { return is_playing_; }

    void seek(double place);
    // From one view to another.
    void step(int views);
    // From the start where it was at the end, and the other way round.
    void play(double speed);
    void pause() { is_playing_ = false; }
    // It pauses at its ends.
    void advance(double seconds);

    // Whether another moment is shown than when this was last asked.
    bool takes_moment();
    // Valid until the next call.
    const engine::RefDef& moment();

private:
    trace::TraceReader reader_;
    std::vector<void*> handles_;
    double length_, place_ = 0, speed_ = 1, shown_ = -1;
    bool is_playing_ = false;
    size_t frame_ = size_t(-1); // whose view is before_
    trace::View before_, after_, view_;
    std::vector<engine::Entity> entities_;
    engine::RefDef refdef_ {};
};

} // namespace vkpt
