// SPDX-License-Identifier: GPL-2.0-or-later
// What players write: lights, walks, names of libraries and files.
#include "common/temporary_folder.hpp"
#include "game/files.hpp"
#include "game/library.hpp"
#include "game/light_text.hpp"
#include "game/walk_text.hpp"
#include "ref_vkpt/files/output_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace vkpt::game {

namespace {

namespace fs = std::filesystem;

std::string error_of(const auto& action)
{
    try {
        action();
    } catch (const std::exception& error) {
        return error.what();
    }
    return {};
}

Light parse(std::vector<std::string> words)
{
    Light light;
    parse_light_words(words, light);
    return light;
}

} // namespace

TEST(LightText, WordsMakeALight)
{
    const Light light = parse({ "#ff8000", "450", "6", "flicker", "spot", "40", "orbit", "64", "2.5" });
    EXPECT_EQ(light.colour, glm::vec3(1, 128 / 255.0f, 0));
    EXPECT_EQ(light.value, 450);
    EXPECT_EQ(light.radius, 6);
    EXPECT_EQ(light.style, formats::LightStyle::flicker);
    EXPECT_EQ(light.cone, 40);
    EXPECT_EQ(light.orbit_radius, 64);
    EXPECT_EQ(light.orbit_seconds, 2.5f);
}

TEST(LightText, WhatIsWrittenIsReadAgain)
{
    std::vector<Light> lights { parse({ "red", "500", "2", "pulse" }), parse({ "blue", "spot", "65", "orbit", "32" }) };
    lights[0].origin = { 1.5f, -200.125f, 3e3f };
    lights[1].angles = { -30, 271.5f, 0 };
    EXPECT_EQ(parse_light_file(write_light_file(lights, "vkpt1"), "x"), lights);
}

TEST(LightText, ErrorsNameLineAndWord)
{
    const auto file = [](const char* text) { return error_of([&] { parse_light_file(text, "lights/a.txt"); }); };
    EXPECT_EQ(file("light 0 0 0 0 0\n\n# c\nlamp 1 2 3\n"),
        "lights/a.txt, line 4: a line begins with 'light', not with 'lamp'");
    EXPECT_NE(file("light 0 0 0 0").find("the direction (pitch yaw) is missing"), std::string::npos);
    EXPECT_NE(file("light 0 0 nan 0 0").find("not 'nan'"), std::string::npos);
    EXPECT_NE(file("light 0 0 1e9 0 0").find("from -32768 to 32768"), std::string::npos);
    EXPECT_NE(file("light 0 0 0 0 0 #ff80").find("#rrggbb"), std::string::npos);
    EXPECT_NE(file("light 0 0 0 0 0 mauve").find("'mauve' says nothing"), std::string::npos);
    EXPECT_NE(file("light 0 0 0 0 0 300 4 5").find("'5' is one number too many"), std::string::npos);
    std::string many;
    for (size_t i = 0; i <= max_lights; i++)
        many += "light 0 0 0 0 0\n";
    EXPECT_NE(file(many.c_str()).find("line 97: more than 96 lights"), std::string::npos);
}

TEST(LightText, CodesKeepWhatTheySay)
{
    for (const uint32_t count : { 1u, 7u, 16u })
        for (const float value : { 25.0f, 300.0f, 1900.0f }) {
            formats::CodedLight light { { 1, 0.25f, 0 }, value, 6, formats::LightStyle::sputter, 2, count };
            const int32_t code = formats::encode_light(light);
            EXPECT_GE(code, 0) << "renderers use it as an index";
            const formats::CodedLight back = formats::decode_light(code);
            EXPECT_NEAR(back.colour.x, 1, 1e-6);
            EXPECT_NEAR(back.colour.y, 0.25f, 0.02f);
            EXPECT_EQ(back.colour.z, 0);
            EXPECT_NEAR(back.value / value, 1, 0.04f);
            EXPECT_EQ(back.radius, 6);
            EXPECT_EQ(back.style, light.style);
            EXPECT_EQ(back.phase, 2u);
            EXPECT_EQ(back.count, count);
        }
}

TEST(LightText, StylesStayWithinTheLight)
{
    for (const auto style : { formats::LightStyle::steady, formats::LightStyle::pulse, formats::LightStyle::flicker,
             formats::LightStyle::sputter })
        for (uint32_t phase = 0; phase < 4; phase++) {
            float least = 2, most = -1;
            for (float time = 0; time < 60; time += 0.05f) {
                const float level = formats::light_level(style, phase, time);
                least = std::min(least, level);
                most = std::max(most, level);
            }
            EXPECT_GE(least, 0);
            EXPECT_LE(most, 1.0001f);
            if (style != formats::LightStyle::steady) {
                EXPECT_GT(most - least, 0.3f);
            }
        }
}

TEST(WalkText, WhatIsWrittenIsReadAgain)
{
    TimedInput input { 1.5f, 200, -100, 0, false, true, true, { 0, 90, 0 } };
    const std::vector<WalkAction> actions { GoTo { { 1, 2, 3 } }, Wait { 0.5f }, Look { { -10, 20, 0 } }, input,
        Step { { 1.125f, -2, 3 }, { 5.25f, -90, 0 }, 0.25f, true, false, true },
        Step { { 0, 0, 0 }, { 0, 0, 0 }, 0, false, true, false } };
    EXPECT_EQ(parse_walk_file("step 1 2 3 4 5 jump duck", "x"),
        (std::vector<WalkAction> { Step { { 1, 2, 3 }, { 4, 5, 0 }, 0, true, true, false } }));
    EXPECT_EQ(parse_walk_file(write_walk_file(actions, "m"), "x"), actions);
}

TEST(WalkText, ErrorsNameLineAndWord)
{
    const auto file = [](const char* text) { return error_of([&] { parse_walk_file(text, "walks/a.txt"); }); };
    EXPECT_EQ(file("wait 1\nrun 5\n"), "walks/a.txt, line 2: 'run' is none of goto, wait, look, input, step");
    EXPECT_NE(file("goto 1 2").find("the place (x y z) is missing"), std::string::npos);
    EXPECT_NE(file("wait 1 2").find("'2' is one word too many"), std::string::npos);
    EXPECT_NE(file("input 1 forward 9000").find("from -400 to 400"), std::string::npos);
    EXPECT_NE(file("input 1 fly").find("'fly' is none of"), std::string::npos);
    EXPECT_NE(file("step 1 2 3 4 5 hop").find("'hop' is none of"), std::string::npos);
    EXPECT_NE(file("wait -1").find("from 0"), std::string::npos);
}

TEST(GameFiles, LinksAreNotFollowedAndStrangersFilesStay)
{
    const TemporaryFolder folder("vkpt-text-");
    const TemporaryFolder outside("vkpt-text-");
    const TextFiles files(folder.path(), "lights", "# mark");
    files.write("a", "# mark 1\n");
    files.write("a", "# mark 2\n");
    EXPECT_EQ(files.read("a"), "# mark 2\n");
    std::ofstream(outside.path() / "b.txt") << "# mark\n";
    fs::create_symlink(outside.path() / "b.txt", folder.path() / "lights/b.txt");
    std::ofstream(folder.path() / "lights/c.txt") << "mine";
    EXPECT_NE(error_of([&] { files.write("b", "# mark"); }).find("link"), std::string::npos);
    EXPECT_NE(error_of([&] { files.read("b"); }).find("link"), std::string::npos);
    EXPECT_NE(error_of([&] { files.write("c", "# mark"); }).find("did not write"), std::string::npos);
    for (const char* name : { "", "../x", "a/b", "a.txt", ".", "a b" })
        EXPECT_NE(error_of([&] { files.write(name, "# mark"); }).find("no name for a file"), std::string::npos) << name;
    const TextFiles linked(outside.path(), "lights", "# mark");
    fs::create_directory_symlink(folder.path() / "lights", outside.path() / "lights");
    EXPECT_NE(error_of([&] { linked.write("a", "# mark"); }), "");
    EXPECT_NE(error_of([&] { linked.read("a"); }), "");
    std::ofstream(folder.path() / "lights/big.txt") << std::string(TextFiles::max_bytes + 1, 'x');
    EXPECT_NE(error_of([&] { files.read("big"); }).find("longer than"), std::string::npos);
}

TEST(GameFiles, TheWritableFolderFollowsTheEngine)
{
    const TemporaryFolder home("vkpt-text-");
    Surroundings s { {}, "/engine", home.path(), "" };
    EXPECT_EQ(find_write_folder(s, "vkpt"), std::nullopt);
    fs::create_directories(home.path() / ".yq2/vkpt");
    fs::create_directories(home.path() / ".local/share/YamagiQ2/vkpt");
    fs::create_directories(home.path() / ".mine/baseq2");
    EXPECT_EQ(find_write_folder(s, "vkpt"), home.path() / ".yq2/vkpt");
    s.command_line = { "quake2", "-cfgdir", ".mine" };
    EXPECT_EQ(find_write_folder(s, ""), home.path() / ".mine/baseq2");
    fs::remove_all(home.path() / ".yq2");
    s.command_line.clear();
    EXPECT_EQ(find_write_folder(s, "vkpt"), home.path() / ".local/share/YamagiQ2/vkpt");
}

// Servers can set variables, and put files into game folders.
TEST(GameLibraries, PathsCountOnlyFromTheCommandLine)
{
    std::string reason;
    EXPECT_EQ(resolve_library_name("xatrix", "/engine", {}, reason), fs::path("/engine/xatrix/game.so"));
    EXPECT_EQ(resolve_library_name("/tmp/evil.so", "/engine", {}, reason), std::nullopt);
    EXPECT_NE(reason.find("command line"), std::string::npos);
    EXPECT_EQ(resolve_library_name("../evil", "/engine", {}, reason), std::nullopt);
    EXPECT_EQ(
        resolve_library_name("/my/game.so", "/engine", { "quake2", "/my/game.so" }, reason), fs::path("/my/game.so"));
}

} // namespace vkpt::game
