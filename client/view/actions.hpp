// SPDX-License-Identifier: GPL-2.0-or-later
// What a key does. The help overlay and docs/view.md's list come from the same table.
#pragma once

#include "client/view/state.hpp"

#include <span>

namespace vkpt::client::view {

enum class Modifier { none, shift, control };

struct Action {
    SDL_Keycode key;
    Modifier modifier;
    const char* group; // heading in the help
    const char* keys; // as shown; "": the row before says it
    const char* help;
    void (*run)(State& state);
};

std::span<const Action> actions();

// False: the key means nothing here.
bool run_key(State& state, const SDL_KeyboardEvent& event);

// Held keys that move the camera, as a text for the help.
struct MoveKey {
    const char* keys;
    const char* help;
};
std::span<const MoveKey> move_keys();

// What the keys that are held ask of the camera; `seconds` since the last call.
FlyInput read_move_keys(float seconds);
float held_speed_factor(); // Shift is fast, Alt slow

// Writes the picture as shown, without the interface, under the next free name; tells its name.
void save_picture(State& state);
std::string next_free_name(std::string_view prefix);

} // namespace vkpt::client::view
