// SPDX-License-Identifier: GPL-2.0-or-later
// The files walks/NAME.txt: what a scripted player does, a line after another.
#pragma once

#include "game/light_text.hpp"

#include <variant>

namespace vkpt::game {

// goto X Y Z: walks there, by whatever way there is.
struct GoTo {
    glm::vec3 place { 0 };
    bool operator==(const GoTo&) const = default;
};
// wait SECONDS
struct Wait {
    float seconds = 0;
    bool operator==(const Wait&) const = default;
};
// look PITCH YAW
struct Look {
    glm::vec3 angles { 0 };
    bool operator==(const Look&) const = default;
};
// input SECONDS [forward N] [side N] [up N] [pitch DEGREES] [yaw DEGREES] [attack]: N in units a second; angles turn
// evenly to what is given.
struct TimedInput {
    float seconds = 0, forward = 0, side = 0, up = 0;
    bool turns_pitch = false, turns_yaw = false, attack = false;
    glm::vec3 angles { 0 };
    bool operator==(const TimedInput&) const = default;
};
// step X Y Z PITCH YAW [jump [SHARE]] [duck] [attack]: is there in the next tenth of a second, of which it jumps after
// a SHARE of 0 to 1; what `walk record` writes.
struct Step {
    glm::vec3 place { 0 }, angles { 0 };
    float jump_share = 0;
    bool jump = false, duck = false, attack = false;
    bool operator==(const Step&) const = default;
};
using WalkAction = std::variant<GoTo, Wait, Look, TimedInput, Step>;

inline constexpr std::string_view walk_file_mark = "# vkpt walk";
inline constexpr size_t max_walk_actions = 20'000;

// Throws TextError with `name` and line.
std::vector<WalkAction> parse_walk_file(std::string_view text, std::string_view name);
std::string write_walk_file(std::span<const WalkAction> actions, std::string_view map);

} // namespace vkpt::game
