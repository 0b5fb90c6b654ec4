// SPDX-License-Identifier: GPL-2.0-or-later
// The game module in the real engine, with a player's inputs.
#include "common/quantile.hpp"
#include "common/read_text.hpp"
#include "formats/bsp.hpp"
#include "formats/entities.hpp"
#include "tests/engine/engine_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <iostream>
#include <numeric>
#include <regex>
#include <sstream>

namespace vkpt::tests {

namespace {

namespace fs = std::filesystem;

std::string read_own_map() { return read_text(VKPT_TEST_BUILD_DIR "/game/baseq2/maps/vkpt1.bsp"); }

EngineOptions play(const std::string& script)
{
    EngineOptions options;
    options.game = "vkpt";
    options.width = 96;
    options.height = 64;
    options.arguments = { "+set", "deathmatch", "0", "+set", "maxclients", "1", "+exec", "test.cfg" };
    options.script = script;
    options.cpu_seconds = 600;
    return options;
}

// The player's places, a server frame each, as the server sees them: the game module within a probe.
void watch_player(EngineOptions& options)
{
    options.files["game.so"] = read_text(VKPT_PROBE);
    options.files["outside.so"] = read_text(VKPT_GAME_MODULE); // the engine's user may not look into the build folder
    options.environment = { "VKPT_PROBE_OUTSIDE=home/.yq2/vkpt/outside.so", "VKPT_PROBE_STATES=home/.yq2/vkpt/states" };
}

std::vector<glm::vec3> read_way(const EngineRun& run)
{
    std::vector<glm::vec3> way;
    std::ifstream file(run.result().game_folder / "states");
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string hash;
        int entities = 0, health = 0;
        glm::vec3 place;
        if (words >> hash >> entities >> place.x >> place.y >> place.z >> health && health > -999)
            way.push_back(place);
    }
    return way;
}

std::vector<glm::vec3> read_steps(const fs::path& path)
{
    std::vector<glm::vec3> steps;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string verb;
        glm::vec3 place;
        if (words >> verb >> place.x >> place.y >> place.z && verb == "step")
            steps.push_back(place);
    }
    return steps;
}

// To the way between its places: in a tenth of a second a player runs 30 units.
float find_distance(const std::vector<glm::vec3>& way, glm::vec3 place)
{
    float nearest = way.empty() ? INFINITY : glm::distance(way[0], place);
    for (size_t i = 1; i < way.size(); i++) {
        const glm::vec3 along = way[i] - way[i - 1];
        const float length2 = glm::dot(along, along);
        const float at = length2 > 0 ? std::clamp(glm::dot(place - way[i - 1], along) / length2, 0.0f, 1.0f) : 0;
        nearest = std::min(nearest, glm::distance(way[i - 1] + along * at, place));
    }
    return nearest;
}

// The lines of the console that tell the number of lights, in order.
std::vector<std::string> read_counts(const EngineRun& run)
{
    std::vector<std::string> counts;
    std::smatch number;
    for (const std::string& line : run.lines_with(" of 96 lights")) // the first one behind the map's own text
        if (std::regex_search(line, number, std::regex("([0-9]+) of 96 lights")))
            counts.push_back(number[1]);
    return counts;
}

// By the renderer's `r_speeds`, frame by frame.
std::vector<int> read_emitters(const EngineRun& run)
{
    std::vector<int> counts;
    std::smatch number;
    for (const std::string& line : run.lines_with(" lights"))
        if (std::regex_search(line, number, std::regex("of models +([0-9]+) lights")))
            counts.push_back(std::stoi(number[1]));
    return counts;
}

} // namespace

// Keys held for a while, as a human's; then the same from the file that `walk record` wrote. The recording ends once
// the player stands, so that both walks end at the same place.
TEST(EngineGame, ARecordedWalkIsWalkedAgain)
{
    // Up the stairs, a jump, a turn to the left, backwards and sideways: nowhere into a wall, at whose corners one walk
    // may get caught and not the other.
    EngineOptions options = play("map vkpt1\nwait_100\nwalk record tour\nwait_25\n+forward\nwait_25\nwait_25\nwait_25\n"
                                 "+moveup\nwait_5\n-moveup\nwait_25\n+left\nwait_25\n-left\n-forward\n+back\nwait_25\n"
                                 "-back\n+moveleft\nwait_25\n-moveleft\n+right\nwait_100\n-right\nwait_25\n"
                                 "walk stop\nwait_25\nmap vkpt1\nwait_100\nwalk tour\n");
    for (int i = 0; i < 8; i++) // three times as long
        options.script += "wait_100\n";
    options.script += "quit\n";
    // Every frame is 1/60 s of the game, however long it takes: keys are held for as long on a slow machine.
    options.arguments.insert(options.arguments.begin(), { "+set", "fixedtime", "16667" });
    watch_player(options);
    const EngineRun run(options);
    run.expect_clean();
    ASSERT_FALSE(run.lines_with("steps written to walks/tour.txt").empty()) << run.result().console;
    EXPECT_FALSE(run.lines_with("walk: tour: ended").empty()) << run.result().console;
    const std::vector<glm::vec3> steps = read_steps(run.result().game_folder / "walks/tour.txt");
    ASSERT_GT(steps.size(), 50u);
    float length = 0;
    for (size_t i = 1; i < steps.size(); i++)
        length += glm::distance(steps[i - 1], steps[i]);
    EXPECT_GT(length, 300) << "the recording player has moved";

    // The second walk is what comes behind the last jump, the level's second start, once the player stands there.
    const std::vector<glm::vec3> way = read_way(run);
    const auto start = std::adjacent_find(
        way.rbegin(), way.rend(), [](glm::vec3 after, glm::vec3 before) { return glm::distance(before, after) > 100; });
    ASSERT_NE(start, way.rend()) << run.result().console;
    std::vector<glm::vec3> again(start.base() - 1, way.end());
    again.erase(again.begin(),
        std::find_if(again.begin(), again.end(), [&](glm::vec3 p) { return find_distance(steps, p) < 1; }));
    std::vector<float> distances;
    for (const glm::vec3 step : steps)
        distances.push_back(find_distance(again, step));
    for (const glm::vec3 place : again)
        distances.push_back(find_distance(steps, place));
    const float mean = std::accumulate(distances.begin(), distances.end(), 0.0f) / float(distances.size());
    const float most = find_quantile(distances, 0.95);
    std::cout << steps.size() << " steps, " << length << " units; the second walk is " << mean
              << " units away on average, 95 % of it at most " << most << ", at its end "
              << glm::distance(again.back(), steps.back()) << "\n";
    // A corner may catch a player in the air in one walk and not in the other, who then has to come back.
    constexpr float half_a_player = 16;
    EXPECT_LT(most, half_a_player);
    EXPECT_LT(mean, 3);
    EXPECT_LT(glm::distance(again.back(), steps.back()), 8);
}

TEST(EngineGame, LightsSurviveSavedGamesAndOtherLevels)
{
    EngineOptions options = play(
        "map vkpt1\nwait_100\nlight list\nlight add red 300\nlight add green 200 2 spot 30\nlight list\n"
        "+forward\nwait_25\n-forward\nwait_25\nsave one\nwait_25\nlight clear\nlight list\n+back\nwait_25\n-back\n"
        "wait_25\nload one\nwait_100\nlight list\nwait_25\n"
        "gamemap second\nwait_100\nlight list\nlight add blue\nlight list\nwait_25\n"
        "gamemap vkpt1\nwait_100\nlight list\nwait_25\nsave two\nwait_25\n"
        "gamemap second\nwait_100\nlight list\nwait_25\nload two\nwait_100\nlight list\nwait_25\nquit\n");
    options.files["maps/second.bsp"] = read_own_map();
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_EQ(read_counts(run), (std::vector<std::string> { "0", "2", "0", "2", "0", "1", "2", "1", "2" }))
        << run.result().console;
    const std::string saved = read_text(run.result().game_folder / "save/two/vkpt1.lights.sav");
    EXPECT_NE(saved.find("spot 30"), std::string::npos) << saved;
}

// A map with so many things that the module's lights find no room.
TEST(EngineGame, AFullArrayIsToldAndTheGameGoesOn)
{
    const std::string map = read_own_map();
    formats::Bsp bsp = formats::read_bsp(std::as_bytes(std::span(map)), "vkpt1");
    const size_t things = formats::parse_entities(bsp.entity_text, "vkpt1").size();
    constexpr size_t wanted = 980; // of 1024
    for (size_t i = things; i < wanted; i++)
        bsp.entity_text += "{\n\"classname\" \"info_notnull\"\n\"origin\" \"0 0 64\"\n}\n";
    const auto bytes = formats::write_bsp(bsp);

    EngineOptions options
        = play("map full\nwait_100\nstress 64\nwait_100\nvkpt_game\nwalk explore 5\nwait_100\n"
               "wait_100\nwait_100\nwait_100\nwalk status\nwait_25\nmap vkpt1\nwait_100\nvkpt_game\nwait_25\nquit\n");
    options.files["maps/full.bsp"] = { reinterpret_cast<const char*>(bytes.data()), bytes.size() };
    watch_player(options);
    const EngineRun run(options);
    run.expect_clean();
    const auto told = run.lines_with("of the lights, flares and emitters are not shown until it frees some");
    ASSERT_EQ(told.size(), 1u) << run.result().console;
    EXPECT_NE(told[0].find(" of 1024 entities"), std::string::npos) << told[0];
    std::cout << told[0] << "\n";
    EXPECT_FALSE(run.lines_with("64 emitters in 64 entities").empty()) << run.result().console;
    EXPECT_EQ(run.lines_with("entities in use").size(), 2u) << "it goes on to the next map";
    EXPECT_TRUE(run.lines_with("ERROR").empty()) << run.result().console;
}

TEST(EngineGame, WhatCannotBeLoadedIsToldAndTheGameGoesOn)
{
    struct Case {
        std::string library, lights, reason, reason_of_lights;
    };
    const Case cases[] {
        { "/nowhere/game.so", "# vkpt lights\nlight 0 0 mauve\n", "cannot open shared object", "line 2: the place" },
        { "home/.yq2/vkpt/old.so", "# vkpt lights\nlight 0 0 100 0 0 red -5\n", "game interface version 2, not 3",
            "lights/vkpt1.txt, line 2" },
        { "/usr/lib/yamagi-quake2/ref_soft.so", std::string(2 << 20, 'x'), "", "longer than" },
    };
    for (const Case& bad : cases) {
        EngineOptions options = play("map vkpt1\nwait_100\nlight add red\nlight list\nvkpt_game\nwait_25\nquit\n");
        options.arguments.insert(options.arguments.begin(), { "+set", "vkpt_game_library", bad.library });
        options.files["lights/vkpt1.txt"] = bad.lights;
        options.files["old.so"] = read_text(VKPT_OLD_GAME);
        const EngineRun run(options);
        run.expect_clean();
        ASSERT_EQ(run.lines_with("vkpt_game_library: ").size(), 1u) << run.result().console;
        const std::string told = run.lines_with("vkpt_game_library: ")[0];
        EXPECT_NE(told.find(bad.reason), std::string::npos) << told;
        EXPECT_NE(told.find("The stock game is played instead."), std::string::npos) << told;
        const auto lights = run.lines_with("no lights are loaded");
        ASSERT_EQ(lights.size(), 1u) << run.result().console;
        EXPECT_NE(lights[0].find(bad.reason_of_lights), std::string::npos) << lights[0];
        EXPECT_EQ(read_counts(run), std::vector<std::string> { "1" }) << run.result().console;
        EXPECT_FALSE(run.lines_with("vkpt: wraps ").empty()) << run.result().console;
    }
}

// Ninety-six lights on top of the map's, while a demo is recorded: played without the module it shows them all.
TEST(EngineGame, LightsAreInRecordedDemos)
{
    std::string lights = "# vkpt lights\n";
    for (int i = 0; i < 96; i++)
        lights += fmt::format("light {} {} 100 0 0 white 100\n", i % 12 * 24 - 132, i / 12 * 24 - 84);
    EngineOptions options = play(
        "set r_speeds 1\nmap vkpt1\nwait_100\nlight clear\nwait_25\nlight undo\nwait_100\n"
        "record tour\nwait_100\nwait_100\nwait_100\nlight edit\nwait_25\nwait_100\nstop\nlight list\nwait_100\nquit\n");
    options.files["lights/vkpt1.txt"] = lights;
    const EngineRun run(options);
    run.expect_clean();
    EXPECT_EQ(read_counts(run), std::vector<std::string> { "96" }) << "the list is longer than a message\n"
                                                                   << run.result().console;
    EXPECT_EQ(run.lines_with(": #ffffff 100 4").size(), 96u);
    const std::vector<int> emitters = read_emitters(run);
    ASSERT_GT(emitters.size(), 20u) << run.result().console;
    const int all = std::ranges::max(emitters);
    EXPECT_EQ(all - std::ranges::min(emitters), 96);
    const std::string demo = read_text(run.result().game_folder / "demos/tour.dm2");
    ASSERT_FALSE(demo.empty()) << run.result().console;

    EngineOptions replay = play("");
    replay.game = "baseq2";
    replay.files["demos/tour.dm2"] = demo;
    replay.arguments = { "+set", "timedemo", "1", "+set", "cl_predict", "0", "+set", "nextdemo", "quit", "+set",
        "r_speeds", "1", "+demomap", "tour.dm2" };
    const EngineRun shown(replay);
    shown.expect_clean();
    EXPECT_GE(std::ranges::count(read_emitters(shown), all), 10) << shown.result().console;
}

} // namespace vkpt::tests
