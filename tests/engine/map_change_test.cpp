// SPDX-License-Identifier: GPL-2.0-or-later
// Many maps in a row: nothing crashes, nothing piles up.
#include "tests/engine/engine_run.hpp"

#include <cstdio>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace vkpt::tests {

namespace {

constexpr double mebibyte = 1024 * 1024;

// Every map of our data, ours first.
std::vector<std::string> list_maps()
{
    std::vector<std::string> maps { own_map };
    const std::filesystem::path folder = VKPT_TEST_BUILD_DIR "/game/baseq2/maps";
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ".bsp" && entry.path().stem() != own_map)
                maps.push_back(entry.path().stem().string());
    std::sort(maps.begin() + 1, maps.end());
    return maps;
}

std::vector<double> measure_map_changes(int count)
{
    const auto maps = list_maps();
    EngineOptions options;
    options.width = 160;
    options.height = 90;
    options.cpu_seconds = 3000;
    for (int i = 0; i < count; i++)
        options.script += "map " + maps[size_t(i) % maps.size()] + "\nwait_25\n" + memory_mark;
    options.script += "quit\n";
    options.arguments = { "+exec", "test.cfg" };
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_EQ(run.lines_with("server initialization").size(), size_t(count)) << run.result().console;

    std::vector<double> mebibytes;
    for (const uint64_t bytes : run.result().marked_memory)
        mebibytes.push_back(double(bytes) / mebibyte);
    EXPECT_EQ(mebibytes.size(), size_t(count));
    for (size_t i = 0; i < mebibytes.size(); i++)
        std::printf("after map %zu (%s): %.1f MiB\n", i + 1, maps[i % maps.size()].c_str(), mebibytes[i]);
    return mebibytes;
}

// Mean growth a map, by least squares; what the first `skip` maps bring (caches, pools) does not count.
double growth_per_map(const std::vector<double>& memory, size_t skip)
{
    const double count = double(memory.size() - skip);
    const double mean = std::accumulate(memory.begin() + std::ptrdiff_t(skip), memory.end(), 0.0) / count;
    double above = 0, below = 0;
    for (size_t i = skip; i < memory.size(); i++) {
        const double x = double(i - skip) - (count - 1) / 2;
        above += x * (memory[i] - mean);
        below += x * x;
    }
    return above / below;
}

} // namespace

TEST(GrowthPerMap, IsTheSlope)
{
    EXPECT_NEAR(growth_per_map({ 100, 5, 7, 9, 11 }, 1), 2, 1e-9);
    EXPECT_NEAR(growth_per_map({ 5, 5, 5 }, 0), 0, 1e-9);
}

TEST(Engine, ChangesMapsTenTimes)
{
    const auto memory = measure_map_changes(10);
    ASSERT_EQ(memory.size(), 10u);
    EXPECT_LT(growth_per_map(memory, 3), 1.0) << "MiB a map";
}

TEST(Engine, LongChangesMapsFiftyTimes)
{
    const auto memory = measure_map_changes(50);
    ASSERT_EQ(memory.size(), 50u);
    EXPECT_LT(growth_per_map(memory, 10), 0.1) << "MiB a map";
}

} // namespace vkpt::tests
