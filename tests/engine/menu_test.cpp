// SPDX-License-Identifier: GPL-2.0-or-later
// The engine's own video menu, our page of settings and photo mode, worked by keys.
#include "common/read_text.hpp"
#include "tests/engine/engine_run.hpp"
#include "tests/engine/picture_statistics.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {

namespace {

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
    const std::string capture = capture_some;
    const std::string keys = std::string(display_mark) + "wait_25\n"; // the last key's frames
    options.script = "wait_25\n" + capture + "menu_video\nwait_5\n"
        + keys
        // The menu has asked for the restart, too, but behind this script.
        + "vid_renderer\nvid_restart\nwait_25\nmenu_video\nwait_5\n" + keys
        + "wait_5\nvid_gamma\nvk_intensity\nvk_overbrightbits\n" + capture + "quit\n";
    options.display_commands = {
        // From "Custom" to "Vulkan", which is this renderer, and up around the corner to "apply".
        press_keys({ "Left", "Up", "Return" }),
        // Three rows more than before lie above "apply", where the cursor was.
        press_keys({ "Up", "Up", "Up", "Up", "Up", "Right", "Right", "Up", "Right", "Up", "Up", "Right", "Escape" }),
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
        press_keys({ "Down", "Down", "Right", "Right", "Down", "Down", "Down", "Left", "Escape" }),
        press_keys({ "Right", "Escape" }),
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

// Mouse motion moves the page's pointer and not the player. The lines of console and chat are typed as ever, while the
// page is open: what is typed runs behind the script, and ends the engine.
TEST(Engine, SettingsPageHasTheMouseAndLeavesTypingAlone)
{
    EngineOptions options;
    options.render_scale = 100;
    options.script = "wait_25\ncamera\npt_menu\nwait_5\n" + std::string(display_mark) + "wait_25\npt_bounces\ncamera\n"
        + "messagemode\nwait_5\n" + display_mark;
    const std::string look = " && sleep 0.2 && "; // the engine does, once a frame
    const auto move = [&](const std::string& way) { return look + "xdotool mousemove_relative -- " + way; };
    const std::string click = look + "xdotool mousedown 1" + look + "xdotool mouseup 1";
    const auto type = [&](const std::string& text) {
        return look + "xdotool type --delay 100 '" + text + "' && " + press_keys({ "Return" });
    };
    options.display_commands = {
        press_keys({}) + move("-10 10") + move("-40 10") + click + click, // on the third row
        press_keys({}) + type("hello") + " && " + press_keys({ "grave" })
            + type("set typed_in console;typed_in;pt_bounces;wait_25;quit"),
    };
    options.arguments = { "+set", "pt_render_scale", "25", "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_EQ(run.lines_with("\"pt_bounces\" is \"3\"").size(), 2u) << run.result().console;
    const auto cameras = run.lines_with(") 90"); // the view's angle
    ASSERT_EQ(cameras.size(), 2u) << run.result().console;
    EXPECT_EQ(cameras[0], cameras[1]) << "the player has turned";
    EXPECT_EQ(run.lines_with("\"typed_in\" is \"console\"").size(), 1u) << run.result().console;
    EXPECT_EQ(run.lines_with(": hello").size(), 1u) << run.result().console;
}

// The engine's menus pause the game, too, but that is no wish for a photograph.
TEST(Engine, PausesBeginPhotoModeAndMenusDoNot)
{
    EngineOptions options;
    const std::string info = "wait_25\npt_photo info\n";
    options.script = "wait_25\npause\n" + info + "pause\n" + info + "menu_video\n" + info + "quit\n";
    options.arguments = { "+set", "pt_render_scale", "25", "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    run.expect_clean();
    const auto lines = run.lines_with("pt_photo: ");
    ASSERT_EQ(lines.size(), 3u) << run.result().console;
    EXPECT_NE(lines[0].find("samples"), std::string::npos) << lines[0];
    for (const size_t i : { 1, 2 })
        EXPECT_NE(lines[i].find("photo mode is off"), std::string::npos) << lines[i];
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
        press_keys({ "w", "Right", "Up", "Return" }),
        press_keys({ "Escape" }),
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
