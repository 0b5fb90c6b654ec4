// SPDX-License-Identifier: GPL-2.0-or-later
// The window: restarts, sizes, full screen, synchronisation.
#include "tests/engine/engine_run.hpp"
#include "tests/engine/picture_statistics.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {

namespace {

// The number in "frame000017.png".
int frame_number(const std::filesystem::path& picture) { return std::stoi(picture.stem().string().substr(5)); }

// The last picture of each `capture_some`: between two of them frame numbers leap, or the renderer was started anew,
// which then captures into a new folder.
std::vector<formats::Image> captured(const EngineRun& run)
{
    std::vector<formats::Image> last;
    for (int start = 1;; start++) {
        const auto pictures = list_pictures(run.captures(start));
        if (pictures.empty())
            return last;
        for (size_t i = 0; i < pictures.size(); i++)
            if (i + 1 == pictures.size() || frame_number(pictures[i + 1]) != frame_number(pictures[i]) + 1)
                last.push_back(load_picture(pictures[i]));
    }
}

void expect_sizes(const EngineRun& run, const std::vector<std::pair<int, int>>& sizes)
{
    const std::vector<formats::Image> pictures = captured(run);
    ASSERT_EQ(pictures.size(), sizes.size()) << run.result().console;
    EXPECT_FALSE(run.lines_with("captured frames are in ").empty()) << run.result().console;
    for (size_t i = 0; i < sizes.size(); i++) {
        EXPECT_EQ(pictures[i].width, sizes[i].first) << i;
        EXPECT_EQ(pictures[i].height, sizes[i].second) << i;
        EXPECT_LT(measure_picture(pictures[i]).black, 0.9) << i;
    }
}

} // namespace

// Into each mode, and twice into the same.
TEST(Engine, RestartsVideoInOtherModes)
{
    EngineOptions options;
    const std::string capture = capture_some;
    options.script = "wait_5\n" + capture + "vid_restart\nwait_25\nvid_restart\nwait_25\n" + capture
        + "r_customwidth 400\nr_customheight 300\nvid_restart\nwait_25\n" + capture + "r_mode 0\nvid_restart\nwait_25\n"
        + capture + "r_mode -2\nvid_fullscreen 2\nvid_restart\nwait_25\n" + capture
        + "vid_fullscreen 1\nvid_restart\nwait_25\n" + capture
        + "r_mode -1\nvid_fullscreen 0\nr_customwidth 161\nr_customheight 97\nr_vsync 0\nvid_restart\nwait_25\n"
        + capture + "quit\n";
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+map", own_map, "+exec", "test.cfg" };
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_EQ(run.lines_with("Successfully loaded ref_vkpt.so").size(), 8u);
    constexpr std::pair desktop { 1280, 960 }; // the virtual display's
    const std::pair configured { options.width, options.height };
    expect_sizes(run, { configured, configured, { 400, 300 }, { 320, 240 }, desktop, desktop, { 161, 97 } });
}

// What a desktop does to a window while the game runs: other sizes, out of sight, back again.
TEST(Engine, FollowsItsWindow)
{
    const std::string window = "xdotool search --class quake2 ";
    EngineOptions options;
    const std::string capture = capture_some;
    options.script = "wait_25\n" + capture + display_mark + capture + display_mark + display_mark + capture
        + display_mark + "wait_25\nvid_restart\nwait_25\n" + capture + "quit\n";
    options.display_commands
        = { window + "windowsize 402 299", window + "windowunmap", window + "windowmap", window + "windowsize 97 61" };
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+map", own_map, "+exec", "test.cfg" };
    const EngineRun run(options);
    run.expect_clean();
    const std::pair configured { options.width, options.height };
    // After the restart r_customwidth holds again.
    expect_sizes(run, { configured, { 402, 299 }, { 402, 299 }, configured });
}

} // namespace vkpt::tests
