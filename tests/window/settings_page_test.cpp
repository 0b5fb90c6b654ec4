// SPDX-License-Identifier: GPL-2.0-or-later
// pt_menu worked by SDL's events, as a player's keys and mouse: what it sets, and what the engine gets of them.
#include "tests/overlay/sdl_events.hpp"
#include "tests/window/mock_window.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

class SettingsPage : public testing::Test {
protected:
    SettingsPage()
        : engine_("8.70 x86_64")
        , module_(engine_, window_)
    {
        module_.draw();
        open();
    }

    void open()
    {
        engine_.arguments = { "pt_menu" };
        engine_.commands.at("pt_menu")();
        module_.draw();
    }

    bool press(uint32_t key, bool repeat = false) { return send_event(events_.press(key, repeat)); }
    bool release(uint32_t key) { return send_event(events_.release(key)); }
    // Down and up again, and what it did is there. Whether the engine got both.
    bool type(uint32_t key)
    {
        const bool pressed = press(key), released = release(key);
        EXPECT_EQ(pressed, released);
        module_.draw();
        return pressed;
    }

    bool click(uint8_t button)
    {
        const bool pressed = send_event(events_.press_button(button));
        EXPECT_EQ(send_event(events_.release_button(button)), pressed);
        module_.draw();
        return pressed;
    }
    // RGBA.
    std::vector<uint8_t> see() const
    {
        std::vector<uint8_t> pixels(size_t(window_.width) * size_t(window_.height) * 4);
        EXPECT_TRUE(module_.extension().capture_display(pixels.data()));
        return pixels;
    }

    enum class Screen { console, menu, chat };
    void draw_beneath(Screen screen)
    {
        const engine::Exports8& module = module_.exports();
        module.begin_frame(0);
        if (screen == Screen::console)
            module.draw_stretch_pic(0, 0, window_.width, window_.height, "conback");
        else if (screen == Screen::menu)
            module.draw_fade_screen();
        else
            module.draw_char_scaled(8, 8, frames_++ % 2 ? 11 : 10, 1); // its cursor blinks
        module.end_frame();
    }

    MockWindow window_ { 640, 360 };
    MockEngine engine_;
    ModuleInWindow module_;
    SdlEvents events_;
    int frames_ = 0;
};

TEST_F(SettingsPage, KeepsItsKeysFromTheEngine)
{
    EXPECT_FALSE(type(key_below));
    EXPECT_FALSE(type(key_below));
    EXPECT_FALSE(type(key_right));
    EXPECT_EQ(engine_.get("pt_bounces"), "2");
    EXPECT_FALSE(type(key_escape));
    EXPECT_TRUE(type(key_escape)) << "it is closed";
}

TEST_F(SettingsPage, LeavesKeysToTheConsoleAMenuOrChat)
{
    for (const Screen screen : { Screen::console, Screen::menu, Screen::chat }) {
        SCOPED_TRACE(int(screen));
        for (int i = 0; i < 2; i++) // the cursor is there and not there
            draw_beneath(screen);
        for (const uint32_t key : { key_return, key_below, key_right, key_escape }) {
            EXPECT_TRUE(press(key)) << key;
            EXPECT_TRUE(release(key)) << key;
            draw_beneath(screen);
        }
        EXPECT_EQ(engine_.get("pt_bounces"), "1") << "the preset was stepped";
        module_.draw(2);
        EXPECT_FALSE(type(key_below)) << "it has its keys back";
    }
}

// It starts at the end of the chosen row's line. Lines are ten pixels high in a window so small.
TEST_F(SettingsPage, IsWorkedByTheMouse)
{
    EXPECT_FALSE(send_event(events_.move(-50, 20))) << "it would turn the player";
    EXPECT_FALSE(click(left_mouse_button));
    EXPECT_EQ(engine_.get("pt_bounces"), "2");
    EXPECT_FALSE(click(left_mouse_button));
    EXPECT_EQ(engine_.get("pt_bounces"), "3");
    EXPECT_FALSE(click(right_mouse_button));
    EXPECT_EQ(engine_.get("pt_bounces"), "2");
    EXPECT_FALSE(send_event(events_.move(0, 40)));
    EXPECT_FALSE(click(right_mouse_button));
    EXPECT_EQ(engine_.get("pt_render_scale"), "95");
    EXPECT_FALSE(send_event(events_.turn_wheel(1))); // to "anti-aliasing"
    type(key_left);
    EXPECT_EQ(engine_.get("flt_taa"), "on");
    // A click beside the rows does nothing here, nor in the game.
    EXPECT_FALSE(send_event(events_.move(2000, 0)));
    EXPECT_FALSE(click(left_mouse_button));
    EXPECT_FALSE(send_event(events_.move(-2000, 2000)));
    EXPECT_FALSE(click(left_mouse_button));
    EXPECT_EQ(engine_.get("pt_render_scale"), "95");
    EXPECT_EQ(engine_.get("flt_taa"), "on");
    type(key_escape);
    EXPECT_TRUE(send_event(events_.move(5, 5)));
    EXPECT_TRUE(click(left_mouse_button));
}

TEST_F(SettingsPage, ShowsAPointerOnceTheMouseIsMoved)
{
    const std::vector<uint8_t> before = see();
    send_event(events_.move(-50, 20));
    module_.draw();
    const std::vector<uint8_t> with_pointer = see();
    glm::ivec2 low(window_.width, window_.height), high(-1);
    for (size_t i = 0; i < before.size() / 4; i++)
        if (!std::equal(&before[4 * i], &before[4 * i] + 3, &with_pointer[4 * i])) {
            const glm::ivec2 place(int(i) % window_.width, int(i) / window_.width);
            low = glm::min(low, place);
            high = glm::max(high, place);
        }
    // The page's lines are 35 characters long; the font is not there.
    const glm::ivec2 tip(8 + 8 + 35 * 8 - 50, 8 + 5 + 25 + 20);
    EXPECT_EQ(low, tip);
    EXPECT_EQ(high, tip + 8);
    type(key_escape);
    open(); // it is gone
    EXPECT_EQ(see(), before);
}

// The key that opened the page, or ended the console's line, is still held.
TEST_F(SettingsPage, RepeatsGoWhereThePressWent)
{
    type(key_escape);
    EXPECT_TRUE(press(key_return));
    open();
    for (int i = 0; i < 3; i++) {
        EXPECT_TRUE(press(key_return, true));
        module_.draw();
    }
    EXPECT_EQ(engine_.get("pt_bounces"), "1") << "the preset was stepped";
    EXPECT_TRUE(release(key_return));

    type(key_below);
    type(key_below);
    EXPECT_FALSE(press(key_right));
    for (int i = 0; i < 3; i++)
        EXPECT_FALSE(press(key_right, true));
    module_.draw();
    EXPECT_EQ(engine_.get("pt_bounces"), "2") << "one press, one step";
    EXPECT_FALSE(release(key_right));
}

} // namespace
} // namespace vkpt::tests
