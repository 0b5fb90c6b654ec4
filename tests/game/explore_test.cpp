// SPDX-License-Identifier: GPL-2.0-or-later
// The wandering player in the real server: how much of a map it sees, and that it does not stand still.
#include "tests/game/coverage.hpp"
#include "tests/game/server_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <string>

namespace vkpt::tests {

namespace {

namespace fs = std::filesystem;

formats::Bsp read_map(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes { std::istreambuf_iterator<char>(file), {} };
    return formats::read_bsp(std::as_bytes(std::span(bytes)), path.string());
}

ServerOptions explore(const fs::path& map, long seconds, int seed = 0)
{
    ServerOptions options;
    options.map = map.stem().string();
    options.maps = { map };
    options.frames = seconds * 10 + 40;
    options.settings = { "coop", "1", "vkpt_start", "walk explore 0 " + std::to_string(seed) };
    return options;
}

long find_longest_rest(const std::vector<glm::vec3>& way)
{
    constexpr float still = 2; // units in a frame
    long rest = 0, longest = 0;
    for (size_t i = 1; i < way.size(); i++) {
        rest = glm::distance(way[i - 1], way[i]) < still ? rest + 1 : 0;
        longest = std::max(longest, rest);
    }
    return longest;
}

void expect_tour(const fs::path& map, int seed = 0)
{
    const ServerRun run(explore(map, 600, seed));
    run.expect_clean();
    const formats::Bsp bsp = read_map(map);
    const std::set<size_t> reachable = find_reachable_leaves(bsp), seen = find_seen_leaves(bsp, run.way());
    const auto both = std::ranges::count_if(reachable, [&](size_t leaf) { return seen.contains(leaf); });
    EXPECT_GT(reachable.size(), 100u);
    EXPECT_GE(double(both) / double(reachable.size()), 0.8) << both << " of " << reachable.size() << " leaves";
    EXPECT_LT(find_longest_rest(run.way()), 100) << "frames of a tenth of a second";
    std::cout << map.stem().string() << ", seed " << seed << ": " << both << " of " << reachable.size()
              << " reachable leaves, longest rest " << find_longest_rest(run.way()) << " frames\n";
}

} // namespace

// 1, 6 and 7 once went to and fro on one staircase for most of the time.
TEST(GameExplore, SeesOurMapWhateverTheSeed)
{
    for (const int seed : { 0, 1, 6, 7 })
        expect_tour(VKPT_TEST_BUILD_DIR "/game/baseq2/maps/vkpt1.bsp", seed);
}

TEST(GameExplore, SeesAStrangersMap)
{
    const char* folder = std::getenv("VKPT_TEST_MAPS");
    if (!folder || !fs::exists(fs::path(folder) / "kduel4.bsp"))
        GTEST_SKIP() << "VKPT_TEST_MAPS names no folder with kduel4.bsp";
    for (const int seed : { 0, 4 })
        expect_tour(fs::path(folder) / "kduel4.bsp", seed);
}

TEST(GameExplore, GoesTheSameWayInEveryRun)
{
    const fs::path map = VKPT_TEST_BUILD_DIR "/game/baseq2/maps/vkpt1.bsp";
    const ServerRun first(explore(map, 60)), second(explore(map, 60));
    EXPECT_EQ(first.way(), second.way());
    EXPECT_GT(first.way().size(), 500u);
    ServerOptions other = explore(map, 60);
    other.settings = { "coop", "1", "vkpt_start", "walk explore 0 7" };
    EXPECT_NE(ServerRun(other).way(), first.way());
}

TEST(GameWalk, FollowsAFileOfInputsAndPlaces)
{
    ServerOptions options;
    options.frames = 500;
    options.settings = { "coop", "1", "vkpt_start", "walk tour" };
    options.files["walks/tour.txt"] = "# vkpt walk\ngoto -200 -300 24\ninput 0.5 yaw 90\nwait 1\n";
    const ServerRun run(options);
    run.expect_clean();
    EXPECT_NE(run.console().find("walk: tour: ended"), std::string::npos) << run.console();
    EXPECT_LT(glm::distance(run.way().back(), glm::vec3(-200, -300, 24)), 64);
}

TEST(GameWalk, BadFilesAreTold)
{
    ServerOptions options;
    options.settings = { "coop", "1", "vkpt_start", "walk tour" };
    options.files["walks/tour.txt"] = "# vkpt walk\ngoto -200 -300\n";
    const ServerRun run(options);
    run.expect_clean();
    EXPECT_NE(run.console().find("walks/tour.txt, line 2: the place (x y z) is missing"), std::string::npos)
        << run.console();
}

} // namespace vkpt::tests
