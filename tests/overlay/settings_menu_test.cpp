// SPDX-License-Identifier: GPL-2.0-or-later
// The page of settings: what its lines say and its keys set.
#include "ref_vkpt/overlay/settings_menu.hpp"
#include "tests/overlay/stand_ins.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <string>

namespace vkpt::tests {
namespace {

class Settings : public testing::Test {
protected:
    Settings()
    {
        stand_in_cvars.clear();
        menu_.toggle();
    }

    size_t find_line(const std::string& label)
    {
        const std::vector<PanelLine> lines = menu_.describe(false);
        for (size_t i = 0; i < lines.size(); i++)
            if (lines[i].text.substr(std::min<size_t>(2, lines[i].text.size())).starts_with(label))
                return i;
        ADD_FAILURE() << "there is no row " << label;
        return 0;
    }
    void choose(const std::string& label) { EXPECT_TRUE(menu_.choose_line(find_line(label))); }
    std::string line(const std::string& label) { return menu_.describe(false)[find_line(label)].text; }
    // The cvar's text after each of them.
    std::vector<std::string> press(const char* cvar, const std::vector<MenuKey>& keys)
    {
        std::vector<std::string> texts;
        for (const MenuKey key : keys) {
            menu_.press(key);
            texts.push_back(stand_in_cvars[cvar]);
        }
        return texts;
    }

    SettingsMenu menu_;
    static constexpr MenuKey less = MenuKey::less, more = MenuKey::more;
};

TEST_F(Settings, StepsGoToTheNextPlaceOfTheirOwn)
{
    using Texts = std::vector<std::string>;
    stand_in_cvars["pt_render_scale"] = "67";
    choose("render scale");
    EXPECT_EQ(press("pt_render_scale", { less, less, more }), (Texts { "65", "60", "65" }));
    stand_in_cvars["pt_render_scale"] = "67";
    EXPECT_EQ(press("pt_render_scale", { more, more }), (Texts { "70", "75" }));
    stand_in_cvars["pt_render_scale"] = "27";
    EXPECT_EQ(press("pt_render_scale", { less, less, MenuKey::left_button, MenuKey::right_button }),
        (Texts { "25", "25", "30", "25" }));
    stand_in_cvars["pt_exposure_bias"] = "-0.3";
    choose("brightness");
    EXPECT_EQ(press("pt_exposure_bias", { more, more, more, less }), (Texts { "-0.25", "0", "0.25", "0" }));
}

// Whatever the places look like in binary: 0.3 / 0.1 is less than three.
TEST_F(Settings, StepsMissNoPlace)
{
    stand_in_cvars["vid_gamma"] = "0.1";
    choose("gamma");
    for (int tenths = 2; tenths <= 20; tenths++) {
        menu_.press(more);
        EXPECT_NEAR(std::stod(stand_in_cvars["vid_gamma"]), tenths * 0.1, 1e-6);
    }
    for (int tenths = 19; tenths >= 1; tenths--) {
        menu_.press(less);
        EXPECT_NEAR(std::stod(stand_in_cvars["vid_gamma"]), tenths * 0.1, 1e-6);
    }
}

TEST_F(Settings, LinesThatAreNoRowsAreNotChosen)
{
    const size_t last = menu_.describe(false).size() - 1;
    choose("gamma");
    for (const size_t other : { size_t(0), size_t(1), last, last + 1 })
        EXPECT_FALSE(menu_.choose_line(other)) << other;
    EXPECT_EQ(menu_.chosen_line(), find_line("gamma"));
    EXPECT_TRUE(menu_.describe(false)[menu_.chosen_line()].marked);
}

TEST_F(Settings, FrameTimesStandBesideWhatWasChanged)
{
    const auto note_frames = [&](double milliseconds) {
        for (int i = 0; i < 20; i++)
            menu_.note_frame(milliseconds);
    };
    note_frames(30);
    choose("bounces");
    menu_.press(more);
    EXPECT_TRUE(line("bounces").ends_with(" 2  30.0 > ... ms")) << line("bounces");
    note_frames(44.5);
    choose("glow");
    menu_.press(less);
    note_frames(40);
    EXPECT_TRUE(line("bounces").ends_with(" 2  30.0 > 44.5 ms")) << line("bounces");
    EXPECT_TRUE(line("glow").ends_with(" 0.02  44.5 > 40.0 ms")) << line("glow");
    EXPECT_TRUE(line("gamma").ends_with(" 1.2")) << line("gamma");
    menu_.toggle();
    menu_.toggle();
    EXPECT_TRUE(line("bounces").ends_with(" 2")) << line("bounces");
}

// A queue without a clock: every time is 0.
TEST_F(Settings, NoTimesWithoutAClock)
{
    for (int i = 0; i < 20; i++)
        menu_.note_frame(0);
    choose("bounces");
    menu_.press(more);
    EXPECT_TRUE(line("bounces").ends_with(" 2")) << line("bounces");
}

} // namespace
} // namespace vkpt::tests
