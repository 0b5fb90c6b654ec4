// SPDX-License-Identifier: GPL-2.0-or-later
// The window: restarts, sizes, full screen, synchronisation.
#include "tests/engine/engine_run.hpp"
#include "tests/engine/picture_statistics.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {

namespace {

// Starts capturing into a folder of its own for as long as a few frames take.
std::string capture_into(const std::string& folder)
{
    return "set pt_capture_dir " + folder + "\nset pt_capture_every 1\nwait_5\nset pt_capture_every 0\nwait\n";
}

void expect_size(const EngineRun& run, const std::string& folder, int width, int height)
{
    const auto pictures = list_pictures(run.result().game_folder / folder);
    ASSERT_FALSE(pictures.empty()) << folder << "\n" << run.result().console;
    const formats::Image picture = load_picture(pictures.back());
    EXPECT_EQ(picture.width, width) << folder;
    EXPECT_EQ(picture.height, height) << folder;
    EXPECT_LT(measure_picture(picture).black, 0.9) << folder;
}

} // namespace

TEST(Engine, RestartsVideo)
{
    EngineOptions options;
    options.script = "wait_25\nvid_restart\nwait_25\nvid_restart\nwait_25\nvid_restart\nwait_25\n"
        + capture_into("after") + "quit\n";
    options.arguments = { "+map", own_map, "+exec", "test.cfg" };
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_EQ(run.lines_with("Successfully loaded ref_vkpt.so").size(), 4u);
    expect_size(run, "after", options.width, options.height);
}

TEST(Engine, ChangesModes)
{
    EngineOptions options;
    options.script = "wait_5\n" + capture_into("first")
        + "r_customwidth 400\nr_customheight 300\nvid_restart\nwait_25\n" + capture_into("custom")
        + "r_mode 0\nvid_restart\nwait_25\n" + capture_into("numbered")
        + "r_mode -2\nvid_fullscreen 2\nvid_restart\nwait_25\n" + capture_into("desktop")
        + "r_mode -1\nvid_fullscreen 0\nr_customwidth 161\nr_customheight 97\nr_vsync 0\nvid_restart\nwait_25\n"
        + capture_into("odd") + "quit\n";
    // The window's size is what counts here; the 3D view may be coarse, for a CPU renders it.
    options.arguments = { "+set", "pt_render_scale", "25", "+map", own_map, "+exec", "test.cfg" };
    const EngineRun run(options);
    run.expect_clean();
    expect_size(run, "first", options.width, options.height);
    expect_size(run, "custom", 400, 300);
    expect_size(run, "numbered", 320, 240);
    expect_size(run, "desktop", 1280, 960); // the virtual display's
    expect_size(run, "odd", 161, 97);
}

// What a desktop does to a window while the game runs: other sizes, out of sight, back again.
TEST(Engine, FollowsItsWindow)
{
    const std::string window = "xdotool search --class quake2 ";
    EngineOptions options;
    options.script = "wait_25\n" + capture_into("first") + display_mark + capture_into("resized") + display_mark
        + display_mark + capture_into("shown") + display_mark + "wait_25\nvid_restart\nwait_25\n" + capture_into("restarted")
        + "quit\n";
    options.display_commands = { window + "windowsize 402 299", window + "windowunmap", window + "windowmap",
        window + "windowsize 97 61" };
    options.arguments = { "+set", "pt_render_scale", "25", "+map", own_map, "+exec", "test.cfg" };
    const EngineRun run(options);
    run.expect_clean();
    expect_size(run, "first", options.width, options.height);
    expect_size(run, "resized", 402, 299);
    expect_size(run, "shown", 402, 299);
    expect_size(run, "restarted", options.width, options.height); // r_customwidth holds again
}

TEST(Engine, ChangesSettingsWhileRunning)
{
    EngineOptions options;
    options.script = "wait_25\n";
    for (const char* command : { "r_vsync 0", "r_vsync 1", "vid_gamma 1.6", "pt_bounces 0", "pt_bounces 3",
             "pt_light_subset 1", "pt_light_subset 32", "pt_exposure 2", "pt_tone_map none", "pt_render_scale 50",
             "pt_render_scale 100", "pt_accumulate 1", "pt_accumulate 0", "pt_bounces 99999", "pt_bounces no-number",
             "viewsize 60", "viewsize 100" })
        options.script += std::string(command) + "\nwait_5\n";
    options.script += "quit\n";
    options.arguments = { "+map", own_map, "+exec", "test.cfg" };
    EngineRun(options).expect_clean();
}

} // namespace vkpt::tests
