// SPDX-License-Identifier: GPL-2.0-or-later
// Whose SDL's events are, and what they say, by the layouts of SDL 2 and SDL 3.
#include "ref_vkpt/overlay/key_filter.hpp"
#include "tests/overlay/sdl_events.hpp"
#include "tests/overlay/stand_ins.hpp"

#include <gtest/gtest.h>
#include <initializer_list>

namespace vkpt::tests {
namespace {

class KeyFilterOfSdl : public testing::TestWithParam<int> {
protected:
    KeyFilterOfSdl()
    {
        stand_in_sdl = GetParam();
        filter_.install();
    }

    // None of them reaches the engine.
    void expect_kept(std::initializer_list<SdlEvents::Bytes> list)
    {
        for (const SdlEvents::Bytes& event : list)
            EXPECT_FALSE(send_to_filter(event)) << &event - list.begin();
    }
    void expect_passed(std::initializer_list<SdlEvents::Bytes> list)
    {
        for (const SdlEvents::Bytes& event : list)
            EXPECT_TRUE(send_to_filter(event)) << &event - list.begin();
    }

    KeyFilter filter_;
    const SdlEvents events_ { GetParam() };
};

TEST_P(KeyFilterOfSdl, LeavesAllToTheEngineAtFirst)
{
    expect_passed({ events_.press(key_return), events_.press(key_return, true), events_.release(key_return),
        events_.move(3, 4), events_.press_button(left_mouse_button), events_.release_button(left_mouse_button),
        events_.turn_wheel(1) });
    EXPECT_TRUE(filter_.take_menu_input().empty());
}

TEST_P(KeyFilterOfSdl, MenuHasTheMouseInOrder)
{
    filter_.set_user(KeyUser::menu);
    expect_kept({ events_.move(5, -3), events_.move(1, 1), events_.press_button(left_mouse_button),
        events_.release_button(left_mouse_button), events_.turn_wheel(-1), events_.move(-2, 0),
        events_.press_button(right_mouse_button), events_.move(0, 7) });
    const std::vector<MenuInput> input = filter_.take_menu_input();
    ASSERT_EQ(input.size(), 4u);
    EXPECT_EQ(input[0].mouse, glm::vec2(6, -2));
    EXPECT_EQ(input[0].key, MenuKey::left_button);
    EXPECT_EQ(input[1].mouse, glm::vec2(0));
    EXPECT_EQ(input[1].key, MenuKey::down);
    EXPECT_EQ(input[2].mouse, glm::vec2(-2, 0));
    EXPECT_EQ(input[2].key, MenuKey::right_button);
    EXPECT_EQ(input[3].mouse, glm::vec2(0, 7));
    EXPECT_FALSE(input[3].key);
    EXPECT_TRUE(filter_.take_menu_input().empty());
    // It does nothing in the menu.
    expect_passed({ events_.press_button(middle_mouse_button), events_.release_button(middle_mouse_button) });
}

TEST_P(KeyFilterOfSdl, PhotoModeHasTheMouse)
{
    filter_.set_user(KeyUser::photo);
    expect_kept({ events_.move(5, -3), events_.move(1, 1), events_.turn_wheel(2) });
    const PhotoInput input = filter_.take_photo_input();
    EXPECT_EQ(input.mouse, glm::vec2(6, -2));
    EXPECT_EQ(input.wheel, 2);
}

TEST_P(KeyFilterOfSdl, RepeatsAreThePressUser)
{
    expect_passed({ events_.press(key_return) });
    filter_.set_user(KeyUser::menu);
    expect_passed({ events_.press(key_return, true), events_.release(key_return) });
    EXPECT_TRUE(filter_.take_menu_input().empty());
    expect_kept({ events_.press(key_return), events_.press(key_return, true) });
    EXPECT_EQ(filter_.take_menu_input().size(), 1u);
    filter_.set_user(KeyUser::engine);
    expect_kept({ events_.press(key_return, true), events_.release(key_return) });
    expect_passed({ events_.press(key_return), events_.press(key_return, true), events_.release(key_return) });
}

INSTANTIATE_TEST_SUITE_P(Majors, KeyFilterOfSdl, testing::Values(2, 3));

// SDL 3's wheels may turn in parts.
TEST(KeyFilter, PartsOfANotchAddUp)
{
    stand_in_sdl = 3;
    KeyFilter filter;
    filter.install();
    filter.set_user(KeyUser::menu);
    const SdlEvents events(3);
    for (int i = 0; i < 7; i++)
        EXPECT_FALSE(send_to_filter(events.turn_wheel(0.25f)));
    const std::vector<MenuInput> input = filter.take_menu_input();
    ASSERT_EQ(input.size(), 1u);
    EXPECT_EQ(input[0].key, MenuKey::up);
}

} // namespace
} // namespace vkpt::tests
