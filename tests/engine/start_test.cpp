// SPDX-License-Identifier: GPL-2.0-or-later
// Starting, playing a demo, ending; and failing to start.
#include "tests/engine/engine_run.hpp"

#include <gtest/gtest.h>

#include <regex>

namespace vkpt::tests {

TEST(Engine, StartsAMapAndQuits)
{
    EngineOptions options;
    options.script = "wait_25\npt_info\nwait_5\nquit\n";
    options.arguments = { "+map", own_map, "+exec", "test.cfg" };
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_EQ(run.lines_with("Refresh: ").size(), 0u) << "another renderer was started";
    EXPECT_FALSE(run.lines_with("ref_vkpt").empty());
    EXPECT_TRUE(run.lines_with("unnamed: ").empty()) << "what no one knows as a command is said to the other players";
    EXPECT_TRUE(run.lines_with("ERROR").empty()) << run.result().console;
    const std::regex triangles("triangles\\D*[1-9]");
    EXPECT_TRUE(std::regex_search(run.result().console, triangles)) << "pt_info names no triangles:\n"
                                                                    << run.result().console;
}

TEST(Engine, PlaysOurDemo)
{
    EngineOptions options;
    options.arguments
        = { "+set", "timedemo", "1", "+set", "cl_predict", "0", "+set", "nextdemo", "quit", "+demomap", own_demo };
    const EngineRun run(options);
    run.expect_clean();
    std::smatch figure;
    ASSERT_TRUE(std::regex_search(
        run.result().console, figure, std::regex("([0-9]+) frames, ([0-9.]+) seconds: ([0-9.]+) fps")))
        << run.result().console;
    EXPECT_GE(std::stoi(figure[1]), 150) << "the demo is shorter than 15 seconds";
    EXPECT_GT(std::stod(figure[3]), 0);
    RecordProperty("fps", figure[3]);
}

TEST(Engine, ShowsMenusAndConsole)
{
    EngineOptions options;
    options.script = "wait_5\n";
    for (const char* command : { "toggleconsole", "menu_main", "menu_video", "menu_options", "menu_multiplayer",
             "menu_playerconfig", "menu_credits", "score", "inven", "cmd help" })
        options.script += std::string(command) + "\nwait_5\nforcemenuoff\nwait\n";
    options.script += "quit\n";
    options.arguments = { "+map", own_map, "+exec", "test.cfg" };
    EngineRun(options).expect_clean();
}

TEST(Engine, TakesAScreenshot)
{
    EngineOptions options;
    options.script = "wait_25\nscreenshot png\nwait_5\nscreenshot tga\nwait_5\nquit\n";
    options.arguments = { "+map", own_map, "+exec", "test.cfg" };
    const EngineRun run(options);
    run.expect_clean();
    size_t png = 0, tga = 0;
    const auto folder = run.result().game_folder / "scrnshot";
    ASSERT_TRUE(std::filesystem::is_directory(folder));
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        png += entry.path().extension() == ".png" ? 1 : 0;
        tga += entry.path().extension() == ".tga" ? 1 : 0;
        EXPECT_GT(entry.file_size(), 100u) << entry.path();
    }
    EXPECT_EQ(png, 1u);
    EXPECT_EQ(tga, 1u);
}

namespace {

// What the console says between the attempt to load our module and the engine's next choice.
std::vector<std::string> lines_of_the_failure(const EngineRun& run)
{
    std::vector<std::string> lines;
    bool ours = false;
    for (const std::string& line : run.lines_with("")) {
        if (line.find("Loading library: ref_vkpt") != std::string::npos)
            ours = true;
        if (line.find("Retrying with") != std::string::npos)
            break;
        if (ours && line.find("ref_vkpt: ") != std::string::npos)
            lines.push_back(line);
    }
    return lines;
}

} // namespace

TEST(EngineFallsBack, OnAnUnknownDevice)
{
    EngineOptions options;
    options.script = "quit\n";
    options.arguments = { "+set", "pt_device", "no-such-gpu", "+exec", "test.cfg" };
    options.end_at = "Retrying with"; // with no renderer left, the engine may wait for ever
    const EngineRun run(options);
    EXPECT_FALSE(run.lines_with("Retrying with").empty()) << run.result().console;
    const auto lines = lines_of_the_failure(run);
    ASSERT_EQ(lines.size(), 1u) << run.result().console;
    EXPECT_NE(lines[0].find("no-such-gpu"), std::string::npos) << lines[0];
}

TEST(EngineFallsBack, WithoutAnyVulkanDriver)
{
    EngineOptions options;
    options.script = "quit\n";
    options.arguments = { "+exec", "test.cfg" };
    options.environment = { "VK_ICD_FILENAMES=/nonexistent.json", "VK_DRIVER_FILES=/nonexistent.json" };
    options.end_at = "Retrying with";
    options.validation = false;
    const EngineRun run(options);
    EXPECT_FALSE(run.lines_with("Retrying with").empty()) << run.result().console;
    EXPECT_EQ(lines_of_the_failure(run).size(), 1u) << run.result().console;
}

} // namespace vkpt::tests
