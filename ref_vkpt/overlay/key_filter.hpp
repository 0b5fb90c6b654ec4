// SPDX-License-Identifier: GPL-2.0-or-later
// Keys and mouse for pt_menu and photo mode: the refresh API has none, so that they are taken from SDL before the
// engine sees them, while the menu or photo mode is open.
#pragma once

#include <atomic>
#include <bitset>
#include <glm/vec2.hpp>
#include <mutex>
#include <optional>
#include <vector>

namespace vkpt {

enum class MenuKey { up, down, less, more, left_button, right_button, close };

// What the player did in the menu: the mouse was moved, and then this was pressed.
struct MenuInput {
    glm::vec2 mouse { 0 }; // pixels to the right and down
    std::optional<MenuKey> key;
};

enum class PhotoKey {
    // That count while they are held:
    forward,
    back,
    left,
    right,
    up,
    down,
    roll_left,
    roll_right,
    fast,
    slow,
    // That count when they are pressed:
    brighter,
    darker,
    wider, // the lens
    narrower,
    focus, // where the crosshair is, and there it stays
    autofocus, // wherever the crosshair is
    home, // to the player's eyes
    panel, // shows it or not
    projection, // the next one
    save,
    // A replay's:
    play, // and pause
    reverse,
    step_back,
    step_on,
    slower,
    faster,
    save_replay,
    close,
    count
};

// What the player did since it was last asked for.
struct PhotoInput {
    std::bitset<size_t(PhotoKey::count)> held;
    std::vector<PhotoKey> pressed;
    glm::vec2 mouse { 0 }; // pixels to the right and down
    float wheel = 0; // notches away from the player
};

enum class KeyUser { engine, menu, photo };

// The process has one at a time.
class KeyFilter {
public:
    KeyFilter() = default;
    ~KeyFilter();
    KeyFilter(const KeyFilter&) = delete;
    KeyFilter& operator=(const KeyFilter&) = delete;

    // Between the engine's start of SDL and its end. Nothing happens where there is no SDL. SDL forgets the events that
    // wait at that moment, hence once, at the start, and not with every opening of the menu.
    void install();
    // From now on this user's keys are kept from the engine.
    void set_user(KeyUser user);
    // Since the last call, in order.
    std::vector<MenuInput> take_menu_input();
    PhotoInput take_photo_input();

private:
    using Filter = int (*)(void* context, void* event);
    static int filter(void* context, void* event);
    static bool filter3(void* context, void* event); // SDL 3
    bool passes(const std::byte* event);
    bool press(unsigned code, bool down);
    bool repeat(unsigned code);
    bool turn_wheel(float notches);
    bool move_mouse(glm::vec2 pixels);
    void press_in_menu(MenuKey key);

    std::atomic<KeyUser> user_ = KeyUser::engine;
    bool is_installed_ = false;
    Filter next_ = nullptr; // somebody's before ours
    void* next_context_ = nullptr;
    std::mutex mutex_; // SDL may call from any thread
    std::vector<MenuInput> menu_;
    float menu_wheel_ = 0; // parts of a notch
    PhotoInput photo_;
    std::bitset<1024> held_; // codes whose release is kept from the engine, too
};

} // namespace vkpt
