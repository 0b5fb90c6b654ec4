// SPDX-License-Identifier: GPL-2.0-or-later
// Lines for players' consoles, a few in each server frame: the server drops a player for whom more waits than one
// message holds.
#pragma once

#include "game/contract.hpp"

#include <deque>
#include <string>

namespace vkpt::game {

class Replies {
public:
    // Says the line now if there is room for it in this frame, else later. The line's end is added.
    void say(const Imports& engine, Edict* player, std::string line);
    // Once a server frame.
    void begin_frame(const Imports& engine);
    // The player has gone; nullptr: all have.
    void forget(const Edict* player);

    static constexpr size_t max_bytes_per_frame = 400; // of a message's 1400
    static constexpr size_t max_line = 300;

private:
    struct Line {
        Edict* player;
        std::string text;
    };
    std::deque<Line> waiting_;
    size_t bytes_ = 0; // said in this frame
};

} // namespace vkpt::game
