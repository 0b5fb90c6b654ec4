// SPDX-License-Identifier: GPL-2.0-or-later
// The engine's own video menu, our page of settings and photo mode, worked by keys.
#include "common/read_text.hpp"
#include "tests/engine/engine_run.hpp"
#include "tests/engine/picture_statistics.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {

namespace {

// A key at a time: the engine looks once a frame.
std::string press(const std::vector<std::string>& keys)
{
    std::string command = "xdotool search --class quake2 windowfocus --sync";
    for (const std::string& key : keys)
        command += " && sleep 0.2 && xdotool keydown " + key + " && sleep 0.2 && xdotool keyup " + key;
    return command;
}

// What the console says of a variable: "NAME" is "VALUE".
double printed_number(const EngineRun& run, const std::string& name)
{
    const auto lines = run.lines_with("\"" + name + "\" is \"");
    if (lines.empty())
        return -1;
    const std::string& line = lines.back();
    return std::stod(line.substr(line.find("is \"") + 4));
}

} // namespace

TEST(Engine, VideoMenuChoosesThisRendererAndItsRowsAct)
{
    EngineOptions options;
    options.render_scale = 100;
    const std::string capture = "set pt_capture_every 1\nwait_5\nset pt_capture_every 0\nwait\n";
    const std::string keys = std::string(display_mark) + "wait_25\n"; // the last key's frames
    options.script = "wait_25\n" + capture + "menu_video\nwait_5\n"
        + keys
        // The menu has asked for the restart, too, but behind this script.
        + "vid_renderer\nvid_restart\nwait_25\nmenu_video\nwait_5\n" + keys
        + "wait_5\nvid_gamma\nvk_intensity\nvk_overbrightbits\n" + capture + "quit\n";
    options.display_commands = {
        // From "Custom" to "Vulkan", which is this renderer, and up around the corner to "apply".
        press({ "Left", "Up", "Return" }),
        // Three rows more than before lie above "apply", where the cursor was.
        press({ "Up", "Up", "Up", "Up", "Up", "Right", "Right", "Up", "Right", "Up", "Up", "Right", "Escape" }),
    };
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+set", "pt_render_scale", "25", "+map", own_map,
        "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_EQ(run.lines_with("Successfully loaded ref_vkpt.so").size(), 1u);
    EXPECT_EQ(run.lines_with("Successfully loaded ref_vk.so").size(), 1u) << run.result().console;
    EXPECT_FALSE(run.lines_with("\"vid_renderer\" is \"vk\"").empty()) << run.result().console;
    EXPECT_GT(printed_number(run, "vid_gamma"), 1.05); // the engine's default is 1
    EXPECT_EQ(printed_number(run, "vk_intensity"), 3);
    EXPECT_GT(printed_number(run, "vk_overbrightbits"), 1.15);
    // The next start takes what was chosen.
    EXPECT_NE(read_text(run.result().game_folder / "config.cfg").find("set vid_renderer \"vk\""), std::string::npos);
    const auto before = list_pictures(run.captures(1)), after = list_pictures(run.captures(2));
    ASSERT_FALSE(before.empty() || after.empty()) << run.result().console;
    EXPECT_GT(
        measure_picture(load_picture(after.back())).mean, 1.2 * measure_picture(load_picture(before.back())).mean);
}

// While the page is open its keys do not reach the engine, whose menu escape would open.
TEST(Engine, SettingsPageIsWorkedByKeys)
{
    EngineOptions options;
    options.render_scale = 100;
    const std::string keys = std::string(display_mark) + "wait_25\n"; // the last key's frames
    options.script = "wait_25\npt_menu\nwait_5\n" + keys + "pt_bounces\nflt_taa\necho page\npaused\n" + keys
        + "pt_bounces\necho menu\npaused\nquit\n";
    options.display_commands = {
        press({ "Down", "Down", "Right", "Right", "Down", "Down", "Down", "Left", "Escape" }),
        press({ "Right", "Escape" }),
    };
    options.arguments = { "+set", "pt_render_scale", "25", "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_EQ(run.lines_with("\"pt_bounces\" is \"3\"").size(), 2u) << run.result().console;
    EXPECT_EQ(run.lines_with("\"flt_taa\" is \"on\"").size(), 1u) << run.result().console;
    const auto paused = run.lines_with("\"paused\" is \"");
    ASSERT_EQ(paused.size(), 2u) << run.result().console;
    EXPECT_NE(paused[0].find("is \"0\""), std::string::npos) << paused[0];
    EXPECT_NE(paused[1].find("is \"1\""), std::string::npos) << paused[1];
}

// The game stands still meanwhile, keys move the camera and not the player, and the Enter key alone writes a file.
TEST(Engine, PhotoModeIsWorkedByKeys)
{
    EngineOptions options;
    options.width = 128; // photo mode renders all pixels
    options.height = 72;
    const std::string keys = std::string(display_mark) + "wait_25\n"; // the last key's frames
    options.script = "wait_25\npt_photo\nwait_5\npt_photo info\npt_photo save castle\nwait_5\n" + keys
        + "pt_photo info\necho photo\npaused\n" + keys + "echo game\nwait_25\npaused\nquit\n";
    options.display_commands = {
        press({ "w", "Right", "Up", "Return" }),
        press({ "Escape" }),
    };
    options.arguments = { "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    run.expect_clean();
    const auto positions = run.lines_with("pt_photo: at ");
    ASSERT_EQ(positions.size(), 2u) << run.result().console;
    EXPECT_NE(positions[0].substr(0, positions[0].find(", look")), positions[1].substr(0, positions[1].find(", look")));
    EXPECT_NE(positions[1].find("exposure 0.25"), std::string::npos) << positions[1];
    EXPECT_NE(positions[1].find("aperture 0.5"), std::string::npos) << positions[1];
    const auto paused = run.lines_with("\"paused\" is \"");
    ASSERT_EQ(paused.size(), 2u) << run.result().console;
    EXPECT_NE(paused[0].find("is \"1\""), std::string::npos) << paused[0];
    EXPECT_NE(paused[1].find("is \"0\""), std::string::npos) << paused[1];
    EXPECT_EQ(run.lines_with("pt_photo: wrote").size(), 2u) << run.result().console;
    for (const char* file : { "castle.png", "castle.exr" }) // the name that was waiting for the key
        EXPECT_TRUE(std::filesystem::exists(run.result().game_folder / "vkpt/photos" / file)) << file;
}

} // namespace vkpt::tests
