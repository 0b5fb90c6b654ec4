// SPDX-License-Identifier: GPL-2.0-or-later
// Whether the engine shows something of its own that keys and mouse belong to. The refresh API does not say so, but
// what is drawn does.
#pragma once

#include <string_view>
#include <utility>

namespace vkpt {

class EngineScreen {
public:
    void begin_frame() { had_keys_ = std::exchange(is_shown_, false) | std::exchange(is_typed_in_, false); }

    // What the engine draws.
    void note_fade() { is_shown_ = true; } // a menu stands on it
    void note_picture(std::string_view name) { is_shown_ |= name == "conback"; } // the console's ground
    void note_character(int code) { is_typed_in_ |= code == 10 || code == 11; } // the cursor of a line to type in: chat

    // In this frame, the console or a menu.
    bool is_shown() const { return is_shown_; }
    // In the last one, or a line to type in: keys and mouse are the engine's.
    bool had_keys() const { return had_keys_; }

private:
    bool is_shown_ = false, is_typed_in_ = false, had_keys_ = false;
};

} // namespace vkpt
