// SPDX-License-Identifier: GPL-2.0-or-later
// What happens to the display's side underway: memory that runs out, a surface that is lost.
#include "common/colour.hpp"
#include "common/quantile.hpp"
#include "tests/client/run_program.hpp"
#include "tests/engine/captures.hpp"
#include "tests/engine/engine_run.hpp"
#include "tests/engine/picture_statistics.hpp"
#include "tests/window/st2084.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>

namespace vkpt::tests {

namespace {

namespace fs = std::filesystem;

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

// The display command that writes the window's pixels to a PNG file.
std::string grab_window(const EngineOptions& options, const std::string& path)
{
    return VKPT_GRAB_WINDOW " " + std::to_string(options.width) + " " + std::to_string(options.height) + " " + path;
}

} // namespace

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
    options.display_commands = { grab_window(options, grabbed) };
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    run.expect_clean();
    expect_captured(run, grabbed);
}

// The window is told that its pixels are HDR10: of each, red and green are read back out of 24 bits that the display
// keeps. Darker parts are as an SDR screen shows them, a little brighter at most; lamps are beyond paper white.
TEST(Engine, HdrWindowsShowMoreThanPaperWhite)
{
    const ScratchFolder folder;
    const Faults faults;
    ASSERT_EQ(std::system(faults.begin("hdr 64 1000104008").c_str()), 0); // A2B10G10R10, HDR10_ST2084
    EngineOptions options;
    faults.add_to(options);
    const std::string grabbed = (folder.path() / "window.png").string();
    options.script = std::string("wait_25\npt_hdr 1\nwait_100\nset pt_capture_every 1\nwait_5\n") + display_mark
        + "set pt_capture_every 0\nwait\nquit\n";
    options.display_commands = { grab_window(options, grabbed) };
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+map", own_map, "+exec", "test.cfg" };
    options.render_scale = 100;
    options.cpu_seconds = 900;
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_TRUE(run.lines_with("pt_hdr 1: the desktop offers").empty());
    const std::vector<fs::path> captured = list_pictures(run.captures());
    ASSERT_FALSE(captured.empty());
    const formats::Image window = load_picture(grabbed), image = load_picture(captured.back());
    ASSERT_EQ(window.pixels.size(), image.pixels.size());
    constexpr double paper_white = 200; // pt_hdr_paper_white
    size_t beyond = 0;
    std::vector<double> dark; // as many times as bright as on an SDR screen
    for (size_t i = 0; i < window.pixels.size(); i++) {
        const formats::Rgba8 p = window.pixels[i], sdr = image.pixels[i];
        EXPECT_EQ(sdr.a, 255);
        const uint32_t word = uint32_t(p.r) << 16 | uint32_t(p.g) << 8 | p.b;
        const double green = decode_pq((word >> 10 & 1023) / 1023.0) / paper_white;
        beyond += green > 1.5;
        if (sdr.r > 40 && sdr.r < 140 && std::abs(sdr.r - sdr.g) < 25 && std::abs(sdr.g - sdr.b) < 25) // nearly grey
            dark.push_back(green / decode_srgb(sdr.g / 255.0));
    }
    ASSERT_GT(dark.size(), window.pixels.size() / 20);
    const double ratio = find_median(dark); // the window's frame is not quite the captured one
    EXPECT_GT(ratio, 0.98);
    EXPECT_LT(ratio, 1.15);
    EXPECT_GT(beyond, window.pixels.size() / 500);
}

TEST(Engine, DesktopsWithoutHdrAreToldOfOnce)
{
    EngineOptions options;
    options.script = "wait_25\nr_vsync 0\nwait_25\npt_hdr 0\nwait_5\nquit\n";
    options.arguments = { "+set", "pt_hdr", "1", "+exec", "test.cfg" };
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_EQ(run.lines_with("pt_hdr 1: the desktop offers this window no HDR format").size(), 1u);
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
    options.display_commands = { faults.begin("surface"), grab_window(options, grabbed) };
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_TRUE(faults.is_over()) << "the surface was not lost";
    EXPECT_EQ(run.lines_with("the window's surface was lost").size(), 1u) << run.result().console;
    expect_captured(run, grabbed);
}

// The engine loads the module anew, which goes on with the level.
TEST(Engine, LostDevicesAreReplaced)
{
    const ScratchFolder folder;
    const Faults faults;
    EngineOptions options;
    faults.add_to(options);
    const std::string grabbed = (folder.path() / "window.png").string();
    options.script = std::string("wait_25\n") + display_mark + "wait_25\nset pt_capture_every 1\nwait_5\n"
        + display_mark + "set pt_capture_every 0\nwait\nquit\n";
    options.display_commands = { faults.begin("lost"), grab_window(options, grabbed) };
    options.arguments = { "+set", "pt_capture_dir", capture_name, "+map", own_map, "+exec", "test.cfg" };
    options.cpu_seconds = 600;
    const EngineRun run(options);
    EXPECT_FALSE(run.result().took_too_long) << run.result().console;
    EXPECT_EQ(run.result().status, 0) << run.result().output;
    EXPECT_TRUE(faults.is_over()) << "the device was not lost";
    EXPECT_EQ(run.lines_with("device lost").size(), 1u) << run.result().console;
    EXPECT_EQ(run.lines_with("starting the renderer anew").size(), 1u) << run.result().console;
    expect_captured(run, grabbed);
}

} // namespace vkpt::tests
