// SPDX-License-Identifier: GPL-2.0-or-later
// Tells when the player pauses the game by its key, and when the game goes on. The engine also pauses it while its
// console or a menu is open; that does not count.
#pragma once

#include <algorithm>

namespace vkpt {

class PauseWatch {
public:
    enum class Event { none, paused, resumed };

    // Once a frame. `engine_has_keys`: the console or a menu was shown in the last one. A menu that opens pauses the
    // game before it is drawn, so a pause must last a little.
    Event look(bool is_paused, bool engine_has_keys)
    {
        quiet_frames_ = engine_has_keys ? 0 : std::min(quiet_frames_ + 1, settled);
        paused_frames_ = is_paused ? std::min(paused_frames_ + 1, settled) : 0;
        if (quiet_frames_ < settled || is_paused == was_paused_ || (is_paused && paused_frames_ < settled))
            return Event::none;
        was_paused_ = is_paused;
        return is_paused ? Event::paused : Event::resumed;
    }

private:
    static constexpr int settled = 10; // frames until what the engine does on closing its screens is over

    int quiet_frames_ = 0, paused_frames_ = 0;
    bool was_paused_ = false;
};

} // namespace vkpt
