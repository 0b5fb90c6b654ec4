// SPDX-License-Identifier: GPL-2.0-or-later
// The game module around the stock game, in the real server.
#include "common/read_text.hpp"
#include "tests/game/server_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace vkpt::tests {

namespace {

namespace fs = std::filesystem;

const fs::path own_map = VKPT_TEST_BUILD_DIR "/game/baseq2/maps/vkpt1.bsp";

// Saves, loads, other levels and deaths in turn, every 600 frames.
ServerOptions make_cycle(long frames, long deaths)
{
    ServerOptions options;
    options.frames = frames;
    options.files["maps/second.bsp"] = read_text(own_map);
    options.settings = { "coop", "1", "vkpt_start", "walk explore 0" };
    for (long at = 300; at + 300 < frames; at += 600) {
        options.script[at] = "save test";
        options.script[at + 100] = (at / 600) % 2 ? "load test" : "gamemap second";
        options.script[at + 300] = (at / 600) % 2 ? "gamemap vkpt1" : "load test";
    }
    for (long i = 0; i < deaths; i++)
        options.script[60 + (frames - 100) * i / deaths] = "sv walk die";
    return options;
}

// With the module, and once more without it: the game gets the same calls about players and has to do the same.
void expect_same_states(ServerOptions options, long min_deaths)
{
    options.probe_inside = true;
    const ServerRun wrapped(options);
    wrapped.expect_clean();
    long deaths = 0;
    for (size_t i = 1; i < wrapped.states().size(); i++)
        deaths += wrapped.states()[i].health <= 0 && wrapped.states()[i - 1].health > 0;
    EXPECT_GE(deaths, min_deaths);

    options.probe_inside = options.sanitized = false;
    options.replay = true;
    options.replayed = wrapped.calls();
    std::erase_if(options.script, [](const auto& line) { return line.second.starts_with("sv "); });
    const ServerRun plain(options);
    plain.expect_clean();
    ASSERT_EQ(plain.states().size(), wrapped.states().size());
    for (size_t i = 0; i < plain.states().size(); i++)
        ASSERT_EQ(plain.states()[i].text, wrapped.states()[i].text) << "frame " << i;
}

} // namespace

TEST(GameModule, TheServerSeesWhatTheGameAloneWouldShow) { expect_same_states(make_cycle(1500, 8), 4); }

TEST(GameModule, LightsChangeNothingOfTheGame)
{
    ServerOptions options = make_cycle(1500, 8);
    options.ignore_models = true; // numbers of models that are new later on
    options.files["lights/vkpt1.txt"] = "# vkpt lights\nlight 0 0 100 0 0 red 300 4 flicker orbit 64 4\n"
                                        "light 0 64 100 45 0 #00ff00 200 4 spot 40\n";
    expect_same_states(options, 4);
}

// Half an hour of the game: a hundred deaths, saved and loaded games, other levels.
TEST(GameModule, LongSanitizedRunShowsTheSame)
{
    ServerOptions options = make_cycle(18000, 200);
    options.sanitized = true;
    options.cpu_seconds = 3600;
    expect_same_states(options, 100);
}

TEST(GameModule, SanitizersFindNothing)
{
    ServerOptions options = make_cycle(1300, 6);
    options.sanitized = true;
    options.files["lights/vkpt1.txt"] = "# vkpt lights\nlight 0 0 100 0 0 red 300 4 flicker orbit 64 4\n";
    options.script[70] = "sv flare";
    options.script[80] = "sv stress 200";
    options.script[90] = "sv light add green 200 spot 30";
    options.script[91] = "sv light undo";
    const ServerRun run(options);
    run.expect_clean();
}

TEST(GameModule, FlaresBurnOutAndAreCounted)
{
    ServerOptions options;
    options.settings = { "coop", "1", "vkpt_start", "walk explore 0", "vkpt_flares", "3" };
    options.frames = 460;
    for (long at = 60; at < 64; at++)
        options.script[at] = "sv flare";
    const ServerRun run(options);
    run.expect_clean();
    EXPECT_EQ(run.states()[100].own_entities, 3);
    EXPECT_NE(run.console().find("no flares are left"), std::string::npos) << run.console();
    EXPECT_EQ(run.states().back().own_entities, 0) << "30 seconds later";
}

TEST(GameModule, StressPutsManyEmittersIntoFewEntities)
{
    ServerOptions options;
    options.settings = { "coop", "1", "vkpt_start", "walk explore 0" };
    options.script = { { 60, "sv stress 1024" }, { 160, "sv stress 32 3 fast" }, { 190, "sv stress 0" },
        { 195, "sv stress 5 1 round" } };
    options.frames = 220;
    const ServerRun run(options);
    run.expect_clean();
    EXPECT_NE(run.console().find("1024 emitters in 64 entities"), std::string::npos) << run.console();
    EXPECT_NE(run.console().find("'round' is no pattern"), std::string::npos) << run.console();
    EXPECT_EQ(run.states()[60].own_entities, 12) << "few new ones a message";
    EXPECT_EQ(run.states()[61].own_entities, 24);
    EXPECT_EQ(run.states()[150].own_entities, 64);
    EXPECT_EQ(run.states()[180].own_entities, 32);
    EXPECT_EQ(run.states().back().own_entities, 0);
}

TEST(GameModule, LightsAreLoadedWithTheirMapAndShown)
{
    ServerOptions options;
    options.files["lights/vkpt1.txt"] = "# vkpt lights\nlight 0 0 100 0 0 red\nlight 0 64 100 0 0 blue\n";
    const ServerRun run(options);
    run.expect_clean();
    EXPECT_EQ(run.states().back().own_entities, 2);
}

TEST(GameModule, ABadLightFileIsTold)
{
    ServerOptions options;
    options.files["lights/vkpt1.txt"] = "# vkpt lights\nlight 0 0 100 0 0 red\nlight 0 64 mauve\n";
    const ServerRun run(options);
    run.expect_clean();
    EXPECT_NE(
        run.console().find("lights/vkpt1.txt, line 3: the place (x y z) is a number, not 'mauve'"), std::string::npos)
        << run.console();
    EXPECT_EQ(run.states().back().own_entities, 0);
}

TEST(GameModule, LibrariesThatAreNoneAreToldAndTheStockGamePlays)
{
    for (const auto& [library, reason] :
        { std::pair<std::string, std::string> { "/usr/lib/yamagi-quake2/ref_gl1.so", "no game library" },
            { "/nowhere/game.so", "cannot open shared object" }, { "nomod", "cannot open shared object" },
            { VKPT_GAME_MODULE, "this module itself" }, { VKPT_OLD_GAME, "game interface version 2, not 3" } }) {
        ServerOptions options;
        options.game_library = library;
        const ServerRun run(options);
        run.expect_clean();
        EXPECT_NE(run.console().find(reason), std::string::npos) << library << run.console();
        EXPECT_NE(run.console().find("The stock game is played instead"), std::string::npos) << run.console();
    }
}

// What it says: the game that the module wraps, and that this one plays.
TEST(GameModule, WrapsAModAndHandsItsCommandsOn)
{
    ServerOptions options;
    options.game_library = VKPT_STAND_IN_MOD;
    options.settings = { "coop", "1", "vkpt_start", "walk explore 0" };
    options.files["lights/vkpt1.txt"] = "# vkpt lights\nlight 0 0 100 0 0 red\n";
    options.script = { { 40, "sv stand_in" }, { 41, "sv light list" }, { 50, "save test" }, { 70, "load test" },
        { 100, "sv light list" } };
    options.frames = 120;
    const ServerRun run(options);
    run.expect_clean();
    EXPECT_NE(run.console().find("around the game of " + run.library()), std::string::npos) << run.console();
    EXPECT_NE(run.console().find("stand-in: "), std::string::npos) << run.console();
    EXPECT_NE(run.console().find("1 of 96 lights"), run.console().rfind("1 of 96 lights")) << run.console();
    EXPECT_EQ(run.states().back().own_entities, 1);
}

// A game of other people's, with larger entities than the stock one's: Debian's engine brings it.
TEST(GameModule, WrapsCaptureTheFlag)
{
    const fs::path library = "/usr/lib/yamagi-quake2/ctf/game.so";
    if (!fs::exists(library))
        GTEST_SKIP() << "no " << library;
    ServerOptions options;
    options.game_library = library.string();
    options.settings = { "deathmatch", "1", "ctf", "1", "vkpt_start", "walk explore 0" };
    options.files["lights/vkpt1.txt"] = "# vkpt lights\nlight 0 0 100 0 0 red\n";
    options.script = { { 60, "sv flare" }, { 80, "sv stress 32" }, { 200, "sv walk status" } };
    options.frames = 400;
    const ServerRun run(options);
    run.expect_clean();
    EXPECT_NE(run.console().find("around the game of " + library.string()), std::string::npos) << run.console();
    EXPECT_EQ(run.states()[300].own_entities, 34) << run.console();
    EXPECT_NE(run.console().find(" places seen of "), std::string::npos) << run.console();
}

TEST(GameModule, AGameThatCannotBeWrappedIsPlayedAsItIs)
{
    ServerOptions options;
    options.game_library = VKPT_INCOMPLETE_MOD;
    options.files["lights/vkpt1.txt"] = "# vkpt lights\nlight 0 0 100 0 0 red\n";
    const ServerRun run(options);
    run.expect_clean();
    EXPECT_NE(run.console().find(run.library()
                  + " is played as it is, without lights, flares and walks: it lacks functions of the interface"),
        std::string::npos)
        << run.console();
    EXPECT_EQ(run.states().back().own_entities, 0);
}

TEST(GameModule, OnlyAPlayerAtTheServersMachineMayCommand)
{
    for (const bool is_local : { false, true }) {
        const std::string player = std::string("player ") + (is_local ? "loopback" : "192.0.2.7:27901");
        ServerOptions options;
        options.settings = { "coop", "1" };
        options.script
            = { { 30, player + " light add red" }, { 40, player + " flare" }, { 50, player + " light save mine" } };
        const ServerRun run(options);
        run.expect_clean();
        EXPECT_EQ(run.console().find("only the player at the server's machine") != std::string::npos, !is_local)
            << run.console();
        EXPECT_EQ(fs::exists(run.game_folder() / "lights/mine.txt"), is_local) << run.console();
        EXPECT_EQ(run.states().back().own_entities > 0, is_local) << run.console();
    }
}

// Names that lead out of the folders, and links, pipes and devices in place of files.
TEST(GameModule, PlayersReachNoFileOutsideItsFolders)
{
    const std::string victim = "mine\n", lights = "# vkpt lights\nlight 0 0 100 0 0 red\n";
    ServerOptions options;
    options.settings = { "coop", "1" };
    options.files = { { "victim.txt", victim }, { "lights/other.txt", "somebody's\n" }, { "outside/a.txt", lights },
        { "outside/walk.txt", "# vkpt walk\nwait 1\n" } };
    options.links = { { "lights/victim.txt", "../victim.txt" }, { "lights/linked.txt", "../outside/a.txt" },
        { "lights/device.txt", "/dev/zero" }, { "lights/gone.txt", "../made.txt" }, { "walks", "outside" } };
    long frame = 30;
    const auto type = [&](const std::string& command) { options.script[frame++] = "player loopback " + command; };
    for (const char* name : { "../victim", "/tmp/vkpt-victim", "lights/../../victim", "victim", "linked", "device",
             "gone", "other", "a.txt", "..", "." }) {
        type(std::string("light save ") + name);
        type(std::string("light load ") + name);
    }
    for (const char* name : { "../victim", "/tmp/vkpt-victim", "walk", "new" }) {
        type(std::string("walk record ") + name);
        type("walk stop");
        type(std::string("walk ") + name);
    }
    type("light save mine");
    options.frames = frame + 20;
    const ServerRun run(options);
    run.expect_clean();
    const fs::path folder = run.game_folder();
    EXPECT_EQ(read_text(folder / "victim.txt"), victim);
    EXPECT_EQ(read_text(folder / "lights/other.txt"), "somebody's\n");
    EXPECT_EQ(read_text(folder / "outside/a.txt"), lights);
    EXPECT_EQ(read_text(folder / "outside/walk.txt"), "# vkpt walk\nwait 1\n");
    for (const char* name : { "made.txt", "outside/new.txt", "a.txt", "new.txt" })
        EXPECT_FALSE(fs::exists(folder / name)) << name;
    EXPECT_FALSE(fs::exists("/tmp/vkpt-victim.txt"));
    EXPECT_TRUE(fs::is_symlink(folder / "lights/victim.txt"));
    EXPECT_TRUE(fs::exists(folder / "lights/mine.txt")) << run.console();
    EXPECT_EQ(run.console().find("lights loaded from"), std::string::npos) << run.console();
}

TEST(GameModule, FilesOutsideItsFoldersAreRefused)
{
    ServerOptions options;
    options.files["victim.txt"] = "mine\n";
    options.files["lights/other.txt"] = "somebody's\n";
    options.script
        = { { 20, "sv light save ../victim" }, { 21, "sv light save other" }, { 22, "sv light load ../victim" },
              { 23, "sv walk record ../victim" }, { 24, "sv walk ../victim" }, { 25, "sv light save mine" } };
    const ServerRun run(options);
    run.expect_clean();
    EXPECT_EQ(read_text(run.game_folder() / "victim.txt"), "mine\n");
    EXPECT_EQ(read_text(run.game_folder() / "lights/other.txt"), "somebody's\n");
    EXPECT_TRUE(fs::exists(run.game_folder() / "lights/mine.txt")) << run.console();
}

} // namespace vkpt::tests
