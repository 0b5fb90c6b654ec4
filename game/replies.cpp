// SPDX-License-Identifier: GPL-2.0-or-later
#include "game/replies.hpp"

#include <algorithm>
#include <utility>

namespace vkpt::game {

void Replies::say(const Imports& engine, Edict* player, std::string line)
{
    line.resize(std::min(line.size(), max_line));
    if (!waiting_.empty() || bytes_ + line.size() > max_bytes_per_frame) {
        waiting_.push_back({ player, std::move(line) });
        return;
    }
    bytes_ += line.size() + 1;
    engine.client_print(player, PRINT_HIGH, "%s\n", line.c_str());
}

void Replies::begin_frame(const Imports& engine)
{
    bytes_ = 0;
    for (std::deque<Line> lines = std::exchange(waiting_, {}); !lines.empty(); lines.pop_front())
        say(engine, lines.front().player, std::move(lines.front().text));
}

void Replies::forget(const Edict* player)
{
    std::erase_if(waiting_, [player](const Line& line) { return !player || line.player == player; });
}

} // namespace vkpt::game
