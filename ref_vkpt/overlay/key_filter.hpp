// SPDX-License-Identifier: GPL-2.0-or-later
// Keys for pt_menu: the refresh API has none, so that they are taken from SDL before the engine sees them, while the
// menu is open.
#pragma once

#include <atomic>
#include <bitset>
#include <mutex>
#include <vector>

namespace vkpt {

enum class MenuKey { up, down, less, more, close };

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
    // From now on the menu's keys are kept from the engine, or not.
    void set_open(bool open) { is_open_ = open; }
    // What was pressed since the last call.
    std::vector<MenuKey> take();

private:
    using Filter = int (*)(void* context, void* event);
    static int filter(void* context, void* event);
    static bool filter3(void* context, void* event); // SDL 3
    bool passes(const std::byte* event);
    bool press(MenuKey key, unsigned code, bool down);

    std::atomic<bool> is_open_ = false;
    bool is_installed_ = false;
    Filter next_ = nullptr; // somebody's before ours
    void* next_context_ = nullptr;
    std::mutex mutex_; // SDL may call from any thread
    std::vector<MenuKey> pressed_;
    std::bitset<1024> held_; // codes whose release is kept from the engine, too
};

} // namespace vkpt
