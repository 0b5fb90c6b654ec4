// SPDX-License-Identifier: GPL-2.0-or-later
// The host's parts: game files in the engine's order, scene names, where brush models stand.
#include "client/host/errors.hpp"
#include "client/host/file_system.hpp"
#include "client/host/output_file.hpp"
#include "client/host/scene.hpp"
#include "tests/client/run_program.hpp"

#include <csignal>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/resource.h>

namespace vkpt::tests {
namespace {

using namespace vkpt::client;

void append_int(std::string& text, int32_t value) { text.append(reinterpret_cast<const char*>(&value), sizeof value); }

// A pak of one file.
std::string make_pak(std::string name, const std::string& text)
{
    constexpr int header_bytes = 12, name_bytes = 56;
    std::string pak = "PACK";
    append_int(pak, int32_t(header_bytes + text.size()));
    append_int(pak, name_bytes + 8);
    pak += text;
    name.resize(name_bytes, '\0');
    pak += name;
    append_int(pak, header_bytes);
    append_int(pak, int32_t(text.size()));
    return pak;
}

std::string read(const FileSystem& files, const char* path)
{
    const auto bytes = files.read(path);
    return bytes ? std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size()) : "(missing)";
}

TEST(FileSystem, ArchivesBeatFilesAndGamesBeatBaseq2)
{
    const ScratchFolder folder;
    folder.write("baseq2/a.txt", "loose");
    folder.write("baseq2/only.txt", "only");
    {
        const FileSystem files(folder.path(), "");
        EXPECT_EQ(read(files, "a.txt"), "loose");
    }
    folder.write("baseq2/pak0.pak", make_pak("a.txt", "pak0"));
    EXPECT_EQ(read(FileSystem(folder.path(), ""), "a.txt"), "pak0");
    folder.write("baseq2/pak2.pak", make_pak("a.txt", "pak2"));
    EXPECT_EQ(read(FileSystem(folder.path(), ""), "a.txt"), "pak2");
    folder.write("baseq2/extra.pak", make_pak("a.txt", "extra"));
    EXPECT_EQ(read(FileSystem(folder.path(), ""), "a.txt"), "extra");
    folder.write("mod/A.txt", "mod");
    EXPECT_EQ(read(FileSystem(folder.path(), ""), "a.txt"), "extra");
    const FileSystem files(folder.path(), "mod");
    EXPECT_EQ(read(files, "a.txt"), "mod");
    EXPECT_EQ(read(files, "only.txt"), "only");
}

TEST(FileSystem, CaseAndSlashesDoNotMatter)
{
    const ScratchFolder folder;
    folder.write("baseq2/Maps/Base1.BSP", "map");
    const FileSystem files(folder.path(), "");
    for (const char* path : { "maps/base1.bsp", "MAPS\\BASE1.bsp", "/maps/base1.bsp" }) {
        EXPECT_TRUE(files.exists(path)) << path;
        EXPECT_EQ(read(files, path), "map") << path;
    }
    EXPECT_FALSE(files.exists("maps/base2.bsp"));
    EXPECT_FALSE(files.exists("../baseq2/maps/base1.bsp"));
    EXPECT_EQ(files.list("maps", ".bsp"), std::vector<std::string> { "Maps/Base1.BSP" });
}

TEST(FileSystem, RefusesWhatIsNotThere)
{
    const ScratchFolder folder;
    EXPECT_THROW(FileSystem(folder.path(), ""), Failure);
    folder.write("baseq2/a.txt", "");
    EXPECT_THROW(FileSystem(folder.path(), "mod"), Failure);
}

TEST(FileSystem, AddedFilesAreOverTheRest)
{
    const ScratchFolder folder;
    folder.write("baseq2/maps/a.bsp", "game's");
    folder.write("a.bsp", "mine");
    FileSystem files(folder.path(), "");
    files.add_file("maps/a.bsp", folder.path() / "a.bsp");
    EXPECT_EQ(read(files, "maps/A.bsp"), "mine");
}

TEST(SceneName, HasMapAndCamera)
{
    const SceneName plain = parse_scene_name("maps/base1.bsp");
    EXPECT_EQ(plain.map, "maps/base1.bsp");
    EXPECT_FALSE(plain.camera);
    const SceneName full = parse_scene_name("maps/base1.bsp@1,-2.5,3,10,-90");
    ASSERT_TRUE(full.camera);
    EXPECT_EQ(full.camera->position, glm::vec3(1, -2.5f, 3));
    EXPECT_EQ(full.camera->pitch, 10);
    EXPECT_EQ(full.camera->yaw, -90);
    EXPECT_EQ(parse_scene_name("maps/base1.bsp@1,2,3").camera->yaw, 0);
    for (const char* bad : { "", "base1", "maps/a.bsp@", "maps/a.bsp@1,2,3,4", "maps/a.bsp@1,2,3,4,5,6",
             "maps/a.bsp@1,,3", "maps/a.bsp@1,2,nan", "demo.rtrace" })
        EXPECT_THROW(parse_scene_name(bad), WrongUse) << bad;
}

TEST(PlayerStart, SinglePlayerComesFirst)
{
    const auto entities = formats::parse_entities(R"({ "classname" "info_player_deathmatch" "origin" "1 2 3" }
        { "classname" "info_player_start" "origin" "4 5 6" "angle" "45" })",
        "test");
    const auto camera = find_player_start(entities);
    ASSERT_TRUE(camera);
    EXPECT_EQ(camera->position, glm::vec3(4, 5, 28));
    EXPECT_EQ(camera->yaw, 45);
    EXPECT_EQ(find_player_start({ entities[0] })->position, glm::vec3(1, 2, 25));
    EXPECT_FALSE(find_player_start({}));
}

struct Placement {
    const char* entity;
    std::optional<glm::vec3> origin, angles = glm::vec3(0);
};
class BrushModel : public testing::TestWithParam<Placement> { };
INSTANTIATE_TEST_SUITE_P(Kinds, BrushModel,
    testing::Values(Placement { R"("classname" "func_door" "angle" "-1")", glm::vec3(0) },
        // 64 high, 8 of it stays out
        Placement { R"("classname" "func_door" "angle" "-1" "spawnflags" "1")", glm::vec3(0, 0, 56) },
        Placement { R"("classname" "func_door" "angle" "0" "spawnflags" "1" "lip" "0")", glm::vec3(16, 0, 0) },
        Placement { R"("classname" "func_door_rotating" "spawnflags" "1" "origin" "1 2 3")", glm::vec3(1, 2, 3),
            glm::vec3(0, 90, 0) },
        Placement { R"("classname" "func_plat")", glm::vec3(0, 0, -56) },
        Placement { R"("classname" "func_plat" "height" "100")", glm::vec3(0, 0, -100) },
        Placement { R"("classname" "func_plat" "targetname" "x")", glm::vec3(0) },
        Placement { R"("classname" "func_train" "target" "corner")", glm::vec3(100, 200, 300) },
        Placement { R"("classname" "func_wall")", glm::vec3(0) },
        Placement { R"("classname" "func_wall" "spawnflags" "1")", std::nullopt },
        Placement { R"("classname" "func_wall" "spawnflags" "7")", glm::vec3(0) },
        Placement { R"("classname" "func_explosive" "spawnflags" "1")", std::nullopt },
        Placement { R"("classname" "func_button" "spawnflags" "512")", std::nullopt },
        Placement { R"("classname" "trigger_multiple")", std::nullopt },
        Placement { R"("classname" "func_areaportal")", std::nullopt }));

TEST_P(BrushModel, StandsWhereTheGamePutsIt)
{
    formats::BspModel model {};
    model.mins = glm::vec3(-10, -20, -30);
    model.maxs = model.mins + glm::vec3(16, 32, 64);
    const std::string text = std::string("{ ") + GetParam().entity
        + R"( "model" "*1" } { "classname" "path_corner" "targetname" "corner" "origin" "90 180 270" })";
    const auto entities = formats::parse_entities(text, "test");
    const auto placement = place_brush_model(entities[0], model, entities);
    ASSERT_EQ(placement.has_value(), GetParam().origin.has_value());
    if (placement) {
        EXPECT_EQ(placement->origin, *GetParam().origin);
        EXPECT_EQ(placement->angles, *GetParam().angles);
    }
}

TEST(OutputFile, AppearsOnlyWhenWhole)
{
    const ScratchFolder folder;
    const std::byte bytes[] = { std::byte('a'), std::byte('b') };
    {
        OutputFile file(folder.path() / "a.png");
        file.write(bytes);
        EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.png"));
    }
    EXPECT_TRUE(folder.names().empty());
    {
        OutputFile file(folder.path() / "a.png");
        file.write(bytes);
        file.commit();
    }
    EXPECT_EQ(folder.names(), std::vector<std::string> { "a.png" });
    EXPECT_EQ(folder.read("a.png"), "ab");
    EXPECT_THROW(OutputFile(folder.path() / "none" / "a.png"), Failure);
}

// A limit on the size of files takes the place of a full disk.
TEST(OutputFile, LeavesNothingOnAFullDisk)
{
    const ScratchFolder folder;
    const std::string text(100'000, 'x');
    folder.write("from", text);
    rlimit before {};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto on_excess = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit tight { 40'000, before.rlim_max };
    setrlimit(RLIMIT_FSIZE, &tight);
    for (const bool takes : { false, true }) {
        OutputFile file(folder.path() / "a.rtrace");
        try {
            takes ? file.take(folder.path() / "from") : file.write(std::as_bytes(std::span(text)));
            ADD_FAILURE() << "nothing was said";
        } catch (const Failure& failure) {
            EXPECT_NE(std::string(failure.what()).find("make room"), std::string::npos) << failure.what();
        }
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, on_excess);
    EXPECT_EQ(folder.names(), std::vector<std::string> { "from" });
}

} // namespace
} // namespace vkpt::tests
