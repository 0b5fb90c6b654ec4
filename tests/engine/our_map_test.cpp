// SPDX-License-Identifier: GPL-2.0-or-later
// One session on our map, which every test here looks at: a start takes seconds of CPU time.
#include "tests/client/run_program.hpp"
#include "tests/engine/captures.hpp"
#include "tests/engine/picture_statistics.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <regex>

namespace vkpt::tests {

namespace {

// What reaches the display and the screenshots, while frames are captured.
std::string write_pictures()
{
    return std::string("set pt_capture_every 1\nwait_5\n") + display_mark
        + "screenshot png\nwait_5\nset pt_capture_every 0\nwait\nscreenshot tga\nwait\n";
}

std::string write_settings()
{
    std::string script;
    for (const char* command : { "r_vsync 0", "r_vsync 2", "r_vsync 1", "vid_gamma 1.6", "pt_bounces 0", "pt_bounces 3",
             "pt_light_subset 1", "pt_light_subset 32", "pt_exposure 2", "pt_tone_map none", "pt_render_scale 50",
             "pt_render_scale 100", "pt_accumulate 1", "pt_accumulate 0", "pt_render_scale 25", "pt_bounces 99999",
             "pt_bounces no-number", "viewsize 60", "viewsize 100" })
        script += std::string(command) + "\nwait_5\n";
    return script + "echo settings are over\n";
}

std::string write_menus()
{
    std::string script;
    for (const char* command : { "toggleconsole", "menu_main", "menu_video", "menu_options", "menu_multiplayer",
             "menu_playerconfig", "menu_credits", "score", "inven", "cmd help" })
        script += std::string(command) + "\nwait_5\nforcemenuoff\nwait\n";
    return script + "echo menus are over\n";
}

class OurMap : public testing::Test {
protected:
    struct Session {
        ScratchFolder folder;
        std::filesystem::path window = folder.path() / "window.png";
        std::unique_ptr<EngineRun> run;
    };
    static std::unique_ptr<Session> session_;

    static void SetUpTestSuite()
    {
        session_ = std::make_unique<Session>();
        EngineOptions options;
        options.script = "wait_25\npt_info\nwait_5\n" + write_pictures() + write_settings() + write_menus() + "quit\n";
        options.display_commands = { VKPT_GRAB_WINDOW " " + std::to_string(options.width) + " "
            + std::to_string(options.height) + " " + session_->window.string() };
        options.arguments = { "+set", "pt_capture_dir", capture_name, "+map", own_map, "+exec", "test.cfg" };
        options.cpu_seconds = 600;
        session_->run = std::make_unique<EngineRun>(options);
    }
    static void TearDownTestSuite() { session_ = nullptr; }

    const EngineRun& run() const { return *session_->run; }
    const std::filesystem::path& window() const { return session_->window; }
    std::filesystem::path screenshots() const { return run().result().game_folder / "scrnshot"; }
};

std::unique_ptr<OurMap::Session> OurMap::session_;

} // namespace

TEST_F(OurMap, StartsAndQuits)
{
    run().expect_clean();
    EXPECT_EQ(run().lines_with("Refresh: ").size(), 0u) << "another renderer was started";
    EXPECT_FALSE(run().lines_with("ref_vkpt").empty());
    // What no one knows as a command is said to the other players. (Games differ in what they know of menus.)
    const std::string of_renderer = run().result().console.substr(0, run().result().console.find("settings are over"));
    EXPECT_EQ(of_renderer.find("unnamed: "), std::string::npos) << of_renderer;
    EXPECT_TRUE(run().lines_with("ERROR").empty()) << run().result().console;
    const std::regex triangles("triangles\\D*[1-9]");
    EXPECT_TRUE(std::regex_search(run().result().console, triangles)) << "pt_info names no triangles:\n"
                                                                      << run().result().console;
}

TEST_F(OurMap, WindowAndScreenshotsShowWhatIsCaptured)
{
    expect_captured(run(), window());
    const auto pictures = list_pictures(screenshots());
    ASSERT_EQ(pictures.size(), 1u);
    expect_captured(run(), pictures.front());
}

TEST_F(OurMap, ScreenshotsHaveTheKindThatIsAskedFor)
{
    ASSERT_TRUE(std::filesystem::is_directory(screenshots()));
    std::vector<std::filesystem::path> targas;
    for (const auto& entry : std::filesystem::directory_iterator(screenshots()))
        if (entry.path().extension() == ".tga")
            targas.push_back(entry.path());
    ASSERT_EQ(targas.size(), 1u);
    EXPECT_LT(measure_picture(load_picture(targas.front())).black, 0.9);
}

TEST_F(OurMap, SettingsChangeWhileItRuns)
{
    EXPECT_EQ(run().lines_with("settings are over").size(), 1u) << run().result().console;
}

TEST_F(OurMap, MenusAndConsoleAreShown)
{
    EXPECT_EQ(run().lines_with("menus are over").size(), 1u) << run().result().console;
}

} // namespace vkpt::tests
