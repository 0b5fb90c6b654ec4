// SPDX-License-Identifier: GPL-2.0-or-later
// What a player does in one sitting, in one run of the installed engine, whichever version that is.
#include "common/read_text.hpp"
#include "tests/engine/engine_run.hpp"
#include "tests/engine/picture_statistics.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {

namespace {

// In a mission pack's folder, whose map the base game does not have. It is named as none of the real pack's:
// engine 8.50 comes with entities of its own for some of those.
EngineOptions make_sitting()
{
    EngineOptions options;
    options.game = "rogue";
    options.files["maps/sitting.bsp"] = read_text(VKPT_TEST_BUILD_DIR "/game/baseq2/maps/vkpt1.bsp");
    options.width = 160;
    options.height = 90;
    options.render_scale = 100; // the value that the page's steps begin at
    const std::string capture = capture_some, keys = std::string(display_mark) + "wait_25\n"; // the last key's frames
    const std::string walk = "+forward\nwait_25\n-forward\nwait_5\n";
    options.script = std::string("wait_25\nmenu_video\nwait_5\n") + keys + "map " + own_map + "\nwait_100\n" + capture
        + walk + "pt_menu\nwait_5\n" + keys + "pt_bounces\npt_render_scale\nsave one\nwait_25\n" + walk
        + "load one\nwait_100\nmap sitting\nwait_100\n" + walk + "save two\nwait_25\nload two\nwait_100\n" + capture
        + "vid_restart\nwait_100\n" + capture + "echo sitting is over\nquit\n";
    options.display_commands = {
        press_keys({ "Down", "Down", "Up", "Escape" }),
        press_keys({ "Down", "Down", "Right", "Down", "Down", "Down", "Down", "Left", "Escape" }),
    };
    options.arguments = { "+set", "deathmatch", "0", "+set", "maxclients", "1", "+set", "pt_capture_dir", capture_name,
        "+exec", "test.cfg" };
    options.cpu_seconds = 1200;
    return options;
}

void expect_pictures(const std::vector<std::filesystem::path>& pictures, size_t least)
{
    ASSERT_GE(pictures.size(), least);
    for (const auto& picture : pictures)
        EXPECT_LT(measure_picture(load_picture(picture)).black, 0.9) << picture;
}

} // namespace

TEST(Engine, PlaysThroughASitting)
{
    const EngineRun run(make_sitting());
    run.expect_clean();
    const std::string& console = run.result().console;
    EXPECT_EQ(run.lines_with("Successfully loaded ref_vkpt.so").size(), 2u) << console;
    EXPECT_EQ(run.lines_with("\"pt_bounces\" is \"2\"").size(), 1u) << console;
    EXPECT_EQ(run.lines_with("\"pt_render_scale\" is \"95\"").size(), 1u) << console;
    EXPECT_EQ(run.lines_with("sitting is over").size(), 1u) << console;
    for (const char* save : { "one", "two" })
        EXPECT_TRUE(std::filesystem::exists(run.result().game_folder / "save" / save / "server.ssv")) << save;
    for (const char* error : { "ERROR", "rror:", "ouldn't", "Can't", "Unknown command", "nvalid", "unnamed: " })
        EXPECT_TRUE(run.lines_with(error).empty()) << run.lines_with(error).front();
    expect_pictures(list_pictures(run.captures(1)), 10);
    expect_pictures(list_pictures(run.captures(2)), 5);
}

} // namespace vkpt::tests
