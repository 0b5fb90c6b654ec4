// SPDX-License-Identifier: GPL-2.0-or-later
// Playing a demo; and failing to start.
#include "tests/engine/engine_run.hpp"

#include <gtest/gtest.h>

#include <regex>

namespace vkpt::tests {

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
