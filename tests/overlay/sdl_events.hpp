// SPDX-License-Identifier: GPL-2.0-or-later
// What the player does, as the bytes of SDL's events: their structs as SDL_events.h of SDL 2 and SDL 3 has them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace vkpt::tests {

namespace sdl2 {
struct Keyboard {
    uint32_t type, timestamp, window;
    uint8_t state, repeat, padding[2];
    uint32_t scancode, symbol;
};
struct Motion {
    uint32_t type, timestamp, window, mouse, state;
    int32_t x, y, xrel, yrel;
};
struct Button {
    uint32_t type, timestamp, window, mouse;
    uint8_t button, state, clicks, padding;
    int32_t x, y;
};
struct Wheel {
    uint32_t type, timestamp, window, mouse;
    int32_t x, y;
    uint32_t direction;
};
} // namespace sdl2

namespace sdl3 {
struct Keyboard {
    uint32_t type, reserved;
    uint64_t timestamp;
    uint32_t window, keyboard, scancode, symbol;
    uint16_t modifiers, raw;
    bool down, repeat;
};
struct Motion {
    uint32_t type, reserved;
    uint64_t timestamp;
    uint32_t window, mouse, state;
    float x, y, xrel, yrel;
};
struct Button {
    uint32_t type, reserved;
    uint64_t timestamp;
    uint32_t window, mouse;
    uint8_t button;
    bool down;
    uint8_t clicks, padding;
    float x, y;
};
struct Wheel {
    uint32_t type, reserved;
    uint64_t timestamp;
    uint32_t window, mouse;
    float x, y;
    uint32_t direction;
};
} // namespace sdl3

// Scancodes and buttons.
inline constexpr uint32_t key_return = 40, key_escape = 41, key_right = 79, key_left = 80, key_below = 81,
                          key_above = 82;
inline constexpr uint8_t left_mouse_button = 1, middle_mouse_button = 2, right_mouse_button = 3;

class SdlEvents {
public:
    using Bytes = std::array<std::byte, 128>; // a whole SDL_Event

    explicit SdlEvents(int sdl_major = 2)
        : is_sdl3_(sdl_major >= 3)
    {
    }

    Bytes press(uint32_t scancode, bool repeat = false) const { return key(0x300, scancode, repeat); }
    Bytes release(uint32_t scancode) const { return key(0x301, scancode, false); }
    Bytes move(int x, int y) const
    {
        sdl2::Motion two { .type = 0x400, .x = 9000, .y = 9000, .xrel = x, .yrel = y };
        sdl3::Motion three { .type = 0x400, .x = 9000, .y = 9000, .xrel = float(x), .yrel = float(y) };
        return choose(two, three);
    }
    Bytes press_button(uint8_t number) const { return button(0x401, number); }
    Bytes release_button(uint8_t number) const { return button(0x402, number); }
    Bytes turn_wheel(float notches) const
    {
        sdl2::Wheel two { .type = 0x403, .y = int32_t(notches) };
        sdl3::Wheel three { .type = 0x403, .y = notches };
        return choose(two, three);
    }

private:
    template <class Event> static Bytes bytes_of(const Event& event)
    {
        Bytes bytes {};
        std::memcpy(bytes.data(), &event, sizeof event);
        return bytes;
    }
    template <class Two, class Three> Bytes choose(const Two& two, const Three& three) const
    {
        return is_sdl3_ ? bytes_of(three) : bytes_of(two);
    }
    Bytes key(uint32_t type, uint32_t scancode, bool repeat) const
    {
        const bool down = type == 0x300;
        sdl2::Keyboard two { .type = type, .state = down, .repeat = repeat, .scancode = scancode };
        sdl3::Keyboard three { .type = type, .scancode = scancode, .down = down, .repeat = repeat };
        return choose(two, three);
    }
    Bytes button(uint32_t type, uint8_t number) const
    {
        const bool down = type == 0x401;
        sdl2::Button two { .type = type, .button = number, .state = down };
        sdl3::Button three { .type = type, .button = number, .down = down };
        return choose(two, three);
    }

    bool is_sdl3_;
};

} // namespace vkpt::tests
