// SPDX-License-Identifier: GPL-2.0-or-later
// What reaches the display and the screenshots is what captures hold; and what happens to the display's side underway:
// memory that runs out, a surface that is lost.
#include "tests/client/run_program.hpp"
#include "tests/engine/engine_run.hpp"
#include "tests/engine/picture_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace vkpt::tests {

namespace {

namespace fs = std::filesystem;

// The largest difference of any colour of any pixel, 0..255; 256: pictures of different size.
int largest_difference(const formats::Image& a, const formats::Image& b)
{
    if (a.width != b.width || a.height != b.height)
        return 256;
    int largest = 0;
    for (size_t i = 0; i < a.pixels.size(); i++)
        largest = std::max({ largest, std::abs(a.pixels[i].r - b.pixels[i].r), std::abs(a.pixels[i].g - b.pixels[i].g),
            std::abs(a.pixels[i].b - b.pixels[i].b) });
    return largest;
}

// One of the captured frames is this picture, byte for byte.
void expect_captured(const EngineRun& run, const fs::path& path)
{
    ASSERT_TRUE(fs::exists(path)) << run.result().console;
    const formats::Image picture = load_picture(path);
    const auto captures = list_pictures(run.captures());
    ASSERT_GE(captures.size(), 10u);
    int least = 256;
    for (const fs::path& capture : captures)
        least = std::min(least, largest_difference(picture, load_picture(capture)));
    EXPECT_EQ(least, 0) << path << " is none of the captured frames";
    EXPECT_LT(measure_picture(picture).black, 0.9) << path;
    EXPECT_GT(measure_picture(picture).deviation, 0.01) << path;
}

// The layer in a folder that the engine's user can read; faults are made and ended by shell commands.
class Faults {
public:
    Faults()
    {
        fs::permissions(folder.path(), fs::perms(0777)); // the layer, in the engine, removes the fault
        for (const char* name : { "vkpt_fault_layer.so", "vkpt_fault_layer.json" })
            fs::copy_file(fs::path(VKPT_FAULT_LAYER) / name, folder.path() / name);
    }
    void add_to(EngineOptions& options) const
    {
        options.environment = { "VK_INSTANCE_LAYERS=VK_LAYER_VKPT_faults",
            "VK_LAYER_PATH=" + folder.path().string() + ":/usr/share/vulkan/explicit_layer.d",
            "VKPT_FAULTS=" + file() };
    }
    std::string begin(const std::string& fault) const { return "echo " + fault + " >" + file(); }
    std::string end() const { return "rm " + file(); }
    bool is_over() const { return !fs::exists(file()); }

private:
    std::string file() const { return (folder.path() / "faults").string(); }
    ScratchFolder folder;
};

} // namespace

TEST(Engine, WindowAndScreenshotsShowWhatIsCaptured)
{
    const ScratchFolder folder;
    EngineOptions options;
    const std::string grabbed = (folder.path() / "window.png").string();
    options.script = std::string("wait_25\nset pt_capture_every 1\nwait_5\n") + display_mark
        + "screenshot png\nwait_5\nset pt_capture_every 0\nwait\nquit\n";
    options.display_commands = { VKPT_GRAB_WINDOW " " + std::to_string(options.width) + " "
        + std::to_string(options.height) + " " + grabbed };
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    run.expect_clean();
    expect_captured(run, grabbed);
    const auto screenshots = list_pictures(run.result().game_folder / "scrnshot");
    ASSERT_EQ(screenshots.size(), 1u);
    expect_captured(run, screenshots.front());
}

// Displays may offer no plain format of 8 bits. What is copied into one that encodes is encoded already.
TEST(Engine, WindowsOfSrgbFormatShowTheSame)
{
    const ScratchFolder folder;
    const Faults faults;
    ASSERT_EQ(std::system(faults.begin("format 50").c_str()), 0); // VK_FORMAT_B8G8R8A8_SRGB
    EngineOptions options;
    faults.add_to(options);
    const std::string grabbed = (folder.path() / "window.png").string();
    options.script = std::string("wait_25\nset pt_capture_every 1\nwait_5\n") + display_mark
        + "set pt_capture_every 0\nwait\nquit\n";
    options.display_commands = { VKPT_GRAB_WINDOW " " + std::to_string(options.width) + " "
        + std::to_string(options.height) + " " + grabbed };
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    run.expect_clean();
    expect_captured(run, grabbed);
}

TEST(Engine, MapsThatDoNotFitAreDropped)
{
    const Faults faults;
    EngineOptions options;
    faults.add_to(options);
    options.script = std::string("wait_25\n") + display_mark + "map " + own_map + "\nwait_25\n";
    options.display_commands = { faults.begin("memory 0") };
    options.arguments = { "+exec", "test.cfg" };
    options.end_at = "==== ShutdownGame"; // the level is over, the engine still runs; an error ends its scripts
    options.cpu_seconds = 600;
    const EngineRun run(options);
    EXPECT_FALSE(run.result().took_too_long) << run.result().console;
    const auto lines = run.lines_with("out of memory on ");
    EXPECT_FALSE(lines.empty()) << run.result().console;
    for (const std::string& line : lines)
        EXPECT_NE(line.find("pt_render_scale"), std::string::npos) << line;
}

TEST(Engine, LostSurfacesAreMadeAnew)
{
    const ScratchFolder folder;
    const Faults faults;
    EngineOptions options;
    faults.add_to(options);
    const std::string grabbed = (folder.path() / "window.png").string();
    options.script = std::string("wait_25\n") + display_mark + "set pt_capture_every 1\nwait_5\n" + display_mark
        + "set pt_capture_every 0\nwait\nquit\n";
    options.display_commands = { faults.begin("surface"), VKPT_GRAB_WINDOW " " + std::to_string(options.width) + " "
            + std::to_string(options.height) + " " + grabbed };
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_TRUE(faults.is_over()) << "the surface was not lost";
    EXPECT_EQ(run.lines_with("the window's surface was lost").size(), 1u) << run.result().console;
    expect_captured(run, grabbed);
}

} // namespace vkpt::tests
