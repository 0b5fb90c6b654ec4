// SPDX-License-Identifier: GPL-2.0-or-later
// A window that only SDL's functions know, which the module finds in the test's process, and the module in it: a
// surface without a display.
#pragma once

#include "ref_vkpt/extension.hpp"
#include "tests/contract/mock_engine.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace vkpt::tests {

inline constexpr uint32_t window_minimised = 0x40; // SDL_WINDOW_MINIMIZED

struct MockWindow {
    int width = 96, height = 64; // in the units that windows are asked for
    int density = 1; // pixels in one of them
    uint32_t flags = 0; // SDL's
};

// As SDL does with what the player does, such as SdlEvents' (tests/overlay/sdl_events.hpp). Whether the engine gets it.
bool send_event(std::span<const std::byte> event);

// The real module, loaded for the engine and started in the window.
class ModuleInWindow {
public:
    using Settings = std::vector<std::pair<std::string, std::string>>;
    // `as_window_opens` is called where the engine asks for the window's size.
    ModuleInWindow(MockEngine& engine, MockWindow& window, const Settings& settings = {},
        const std::function<void(const engine::Exports8&)>& as_window_opens = {});
    ~ModuleInWindow();
    ModuleInWindow(const ModuleInWindow&) = delete;
    ModuleInWindow& operator=(const ModuleInWindow&) = delete;

    bool is_running() const { return running_; }
    const engine::Exports8& exports() const;
    const Extension& extension() const;
    // Frames of 2D alone.
    void draw(int frames = 1) const;
    void shut_down();

private:
    struct Table;
    MockEngine& engine_;
    MockWindow& window_;
    void* library_ = nullptr;
    Table* table_ = nullptr;
    bool running_ = false;
};

} // namespace vkpt::tests
