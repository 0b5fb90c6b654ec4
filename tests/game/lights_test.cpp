// SPDX-License-Identifier: GPL-2.0-or-later
// Lights, flares and emitters of the game module, as the real server sees them.
#include "formats/bsp.hpp"
#include "formats/light_code.hpp"
#include "game/contract.hpp"
#include "tests/game/coverage.hpp"
#include "tests/game/server_run.hpp"
#include "tests/map_compiler/tracer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>

namespace vkpt::tests {

namespace {

namespace fs = std::filesystem;

formats::Bsp read_own_map()
{
    const fs::path path = VKPT_TEST_BUILD_DIR "/game/baseq2/maps/vkpt1.bsp";
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes { std::istreambuf_iterator<char>(file), {} };
    return formats::read_bsp(std::as_bytes(std::span(bytes)), path.string());
}

// A player who looks east from the map's start and at `turn` frames north: what he is told stands in the console.
ServerOptions look_around(const std::vector<std::string>& commands, const std::string& lights = "")
{
    ServerOptions options;
    options.settings = { "coop", "1", "vkpt_start", "walk turn" };
    options.files["walks/turn.txt"] = "look 0 0\nwait 6\nlook 0 90\nwait 60\n";
    if (!lights.empty())
        options.files["lights/vkpt1.txt"] = "# vkpt lights\n" + lights;
    long frame = 40;
    for (const std::string& command : commands)
        options.script[frame++] = command;
    options.frames = frame + 5;
    return options;
}

void expect_lines(const ServerRun& run, const std::vector<std::string>& lines)
{
    run.expect_clean();
    size_t at = 0;
    for (const std::string& line : lines) {
        const size_t found = run.console().find(line, at);
        EXPECT_NE(found, std::string::npos) << "'" << line << "' behind\n"
                                            << run.console().substr(at) << "\nin\n"
                                            << run.console();
        if (found == std::string::npos)
            return;
        at = found + line.size();
    }
}

} // namespace

TEST(GameLights, EveryCommandDoesWhatItSays)
{
    const ServerRun run(look_around({ "sv light list", "sv light add #ff8020 450 6 flicker", "sv light list",
        "sv light set #2040ff 200 2 pulse orbit 64 5", "sv light copy", "sv light list", "sv light delete",
        "sv light list", "sv light undo", "sv light list", "sv light clear", "sv light list", "sv light undo",
        "sv light list", "sv light save tour", "sv light clear", "sv light load tour", "sv light list" }));
    expect_lines(run,
        { "0 of 96 lights", "light 1: #ff8020 450 6 flicker", "1 of 96 lights", "set: #2040ff 200 2 pulse orbit 64 5",
            "copy: #2040ff 200 2 pulse orbit 64 5", "2 of 96 lights", "delete: #2040ff", "1 of 96 lights", "2 lights",
            "2 of 96 lights", "2 lights removed", "0 of 96 lights", "2 lights", "2 of 96 lights",
            "2 lights saved in lights/tour.txt", "2 lights removed", "2 lights loaded from lights/tour.txt",
            "2 of 96 lights" });
}

TEST(GameLights, MoveAimAndDragFollowTheView)
{
    // The light is moved to the wall that the player faces, then dragged while he turns about to the north.
    ServerOptions options = look_around({}, "light 0 0 60 0 0 white 300 1 spot 40\n");
    options.script = { { 30, "sv light move" }, { 31, "sv light aim" }, { 40, "sv light grab" },
        { 120, "sv light grab" }, { 130, "sv light save after" } };
    options.frames = 140;
    const ServerRun run(options);
    expect_lines(run, { "move: #ffffff 300 1 spot 40", "aim: #ffffff", "follows your view", "let go" });
    const glm::vec3 player = run.way().back();
    const auto moved = run.own_entities_at(38), dragged = run.own_entities_at(110);
    ASSERT_EQ(moved.size(), 1u);
    ASSERT_EQ(dragged.size(), 1u);
    const glm::vec3 east = moved[0].origin - player, north = dragged[0].origin - player;
    EXPECT_GT(east.x, 30);
    EXPECT_LT(std::abs(east.y), 10) << "to the crosshair";
    EXPECT_GT(north.y, 30);
    EXPECT_LT(std::abs(north.x), 10) << "dragged with the view";
    EXPECT_NEAR(glm::length(north), glm::length(east), 16) << "at the same distance";
}

TEST(GameLights, MarkersShowWhileLightsAreEdited)
{
    ServerOptions options;
    options.files["lights/vkpt1.txt"] = "# vkpt lights\nlight 0 0 100 0 0 red\n";
    options.script = { { 30, "sv light edit" }, { 60, "sv light edit" } };
    const ServerRun run(options);
    expect_lines(run, { "lights are shown", "lights are hidden" });
    for (const auto& [frame, flags] : { std::pair(25l, 0), { 50l, int(game::RF_FULLBRIGHT) }, { 90l, 0 } }) {
        const auto lights = run.own_entities_at(frame);
        ASSERT_EQ(lights.size(), 1u);
        EXPECT_EQ(lights[0].render_flags, flags) << "frame " << frame;
    }
}

TEST(GameLights, NinetySixAreShownAtOnceAndMoreAreRefused)
{
    std::string lights;
    for (int i = 0; i < 96; i++)
        lights += fmt::format("light {} {} 100 0 0 white 100\n", i % 10 * 20, i / 10 * 20);
    ServerOptions options = look_around({ "sv light add red", "sv light list" }, lights);
    const ServerRun run(options);
    expect_lines(run, { "there are 96 lights already", "96 of 96 lights" });
    EXPECT_EQ(run.own_entities_at(options.frames - 1).size(), 96u);
}

TEST(GameFlares, BounceRollSputterAndDie)
{
    ServerOptions options;
    options.settings = { "coop", "1", "vkpt_start", "walk turn" };
    options.files["walks/turn.txt"] = "look -10 90\nwait 60\n";
    options.script[40] = "sv flare";
    options.frames = 360;
    const ServerRun run(options);
    run.expect_clean();
    const auto& way = run.own_entities();
    ASSERT_GT(way.size(), 290u);
    EXPECT_LT(way.size(), 305u) << "30 seconds";
    int bounces = 0;
    long rests_at = 0;
    std::set<int> shades;
    for (size_t i = 2; i < way.size(); i++) {
        const float before = way[i - 1].origin.z - way[i - 2].origin.z, now = way[i].origin.z - way[i - 1].origin.z;
        bounces += before < -1 && now > 1;
        if (glm::distance(way[i].origin, way[i - 1].origin) > 0.01f)
            rests_at = way[i].frame;
        shades.insert(way[i].skin);
    }
    EXPECT_GE(bounces, 1);
    EXPECT_GT(rests_at - way.front().frame, 15) << "it rolls";
    EXPECT_LT(rests_at - way.front().frame, 150) << "it comes to rest";
    EXPECT_GT(glm::distance(way.front().origin, way.back().origin), 100);
    EXPECT_GT(shades.size(), 5u) << "it grows darker before it dies";
    const formats::CodedLight first = formats::decode_light(way.front().skin),
                              last = formats::decode_light(way.back().skin);
    EXPECT_EQ(first.style, formats::LightStyle::sputter);
    EXPECT_LT(last.value, first.value / 2);
}

// Emitters fly the same ways in every run, and through empty space.
TEST(GameStress, PathsAreDeterministicAndClearOfTheMap)
{
    ServerOptions options;
    options.settings = { "coop", "1", "vkpt_start", "walk turn" };
    options.frames = 300;
    options.files["walks/turn.txt"] = "wait 60\n";
    options.script[30] = "sv stress 64 5 fast";
    const ServerRun run(options), again(options);
    run.expect_clean();
    EXPECT_EQ(run.own_entities(), again.own_entities());
    ASSERT_EQ(run.own_entities_at(290).size(), 64u);
    options.script[30] = "sv stress 64 6 fast";
    EXPECT_NE(ServerRun(options).own_entities(), run.own_entities()) << "another seed";

    const formats::Bsp bsp = read_own_map();
    constexpr TraceBox ball { glm::vec3(-2), glm::vec3(2) };
    size_t in_solid = 0;
    for (const OwnEntity& emitter : run.own_entities())
        in_solid += trace_box(bsp, ball, emitter.origin, emitter.origin).starts_solid;
    EXPECT_EQ(in_solid, 0u) << "of " << run.own_entities().size();
    float moved = 0;
    const auto early = run.own_entities_at(100), late = run.own_entities_at(290);
    for (size_t i = 0; i < early.size(); i++)
        moved += glm::distance(early[i].origin, late[i].origin);
    EXPECT_GT(moved / 64, 50) << "they fly";
}

} // namespace vkpt::tests
