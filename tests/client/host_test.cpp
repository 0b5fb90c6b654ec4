// SPDX-License-Identifier: GPL-2.0-or-later
// The host's parts: game files in the engine's order, scene names, where brush models stand.
#include "client/host/client_map.hpp"
#include "client/host/errors.hpp"
#include "client/host/file_system.hpp"
#include "client/host/output_file.hpp"
#include "client/host/private_folder.hpp"
#include "client/host/session_folder.hpp"
#include "tests/client/run_program.hpp"

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

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

int permissions_of(const std::filesystem::path& path)
{
    struct stat found { };
    return stat(path.c_str(), &found) == 0 ? int(found.st_mode & 07777) : -1;
}

void write_file(const std::filesystem::path& path, const std::string& text)
{
    OutputFile file(path);
    file.write(std::as_bytes(std::span(text)));
    file.commit();
}

// /dev/null was once replaced by a regular file.
TEST(OutputFile, DevicesAndPipesStayWhatTheyAre)
{
    const ScratchFolder folder;
    const std::filesystem::path pipe = folder.path() / "pipe", link = folder.path() / "null";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    write_file(pipe, "through");
    char text[16] = {};
    EXPECT_EQ(::read(reader, text, sizeof text), 7);
    EXPECT_STREQ(text, "through");
    close(reader);
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
    std::filesystem::create_symlink("/dev/null", link);
    write_file(link, "nowhere");
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    EXPECT_EQ(folder.names(), (std::vector<std::string> { "null", "pipe" }));
    std::filesystem::create_symlink("/dev/full", folder.path() / "full");
    try {
        write_file(folder.path() / "full", "x");
        ADD_FAILURE() << "nothing was said";
    } catch (const Failure& failure) {
        EXPECT_NE(std::string(failure.what()).find("full: No space left"), std::string::npos) << failure.what();
    }
    // An open file by its number, as /dev/stdout is one: the file itself is written, not its name anew.
    const int file = open((folder.path() / "a").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
    write_file("/proc/self/fd/" + std::to_string(file), "itself");
    EXPECT_EQ(::read(file, text, sizeof text), 6);
    close(file);
}

TEST(OutputFile, KeepsPermissionsAndFollowsLinks)
{
    const ScratchFolder folder;
    const auto path = [&](const char* name) { return folder.path() / name; };
    const mode_t before = umask(027);
    write_file(path("new"), "new");
    umask(before);
    EXPECT_EQ(permissions_of(path("new")), 0640) << "what the umask leaves";
    folder.write("tight", "old");
    chmod(path("tight").c_str(), 0600);
    write_file(path("tight"), "new");
    EXPECT_EQ(permissions_of(path("tight")), 0600);
    folder.write("results/latest", "old");
    std::filesystem::create_symlink("results/latest", path("link"));
    std::filesystem::create_symlink("results/none yet", path("dangling"));
    write_file(path("link"), "new");
    write_file(path("dangling"), "new");
    for (const char* name : { "link", "dangling" })
        EXPECT_TRUE(std::filesystem::is_symlink(path(name))) << name;
    EXPECT_EQ(folder.read("results/latest"), "new");
    EXPECT_EQ(folder.read("results/none yet"), "new");
    std::filesystem::create_symlink("loop", path("loop"));
    EXPECT_THROW(write_file(path("loop"), ""), Failure);
    std::filesystem::create_directory_symlink("results", path("folder"));
    EXPECT_THROW(write_file(path("folder"), ""), Failure);
}

// Somebody who may write beside the file has guessed the working file's name, or made the file itself a link.
TEST(OutputFile, IsNotLedElsewhere)
{
    const ScratchFolder folder;
    folder.write("victim", "precious");
    std::filesystem::create_directory(folder.path() / "shared");
    const std::filesystem::path file = folder.path() / "shared/a.json";
    std::filesystem::create_symlink(
        "../victim", folder.path() / "shared" / (".a.json." + std::to_string(getpid()) + ".part"));
    write_file(file, "mine");
    EXPECT_EQ(folder.read("victim"), "precious");
    EXPECT_EQ(folder.read("shared/a.json"), "mine");
    EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(file)));
    std::filesystem::remove(file);
    std::filesystem::create_symlink("../victim", file);
    chmod((folder.path() / "shared").c_str(), 01777);
    write_file(file, "mine"); // a link of our own
    EXPECT_EQ(folder.read("victim"), "mine");
    if (geteuid() != 0)
        return; // links of others can only be made by root
    ASSERT_EQ(lchown(file.c_str(), 12345, 12345), 0);
    EXPECT_THROW(write_file(file, "again"), Failure);
    EXPECT_EQ(folder.read("victim"), "mine");
}

// In a child, as the signal ends the program.
TEST(OutputFile, LeavesNothingWhenASignalEndsTheProgram)
{
    for (const int signal : { SIGINT, SIGTERM, SIGHUP }) {
        const ScratchFolder folder;
        const pid_t child = fork();
        if (child == 0) {
            rlimit no_core {};
            setrlimit(RLIMIT_CORE, &no_core);
            OutputFile a(folder.path() / "a.png"), b(folder.path() / "b.png");
            raise(signal);
            _exit(0);
        }
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status));
        EXPECT_EQ(WTERMSIG(status), signal);
        EXPECT_TRUE(folder.names().empty()) << folder.names().front();
    }
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
            EXPECT_NE(std::string(failure.what()).find("free some space"), std::string::npos) << failure.what();
        }
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, on_excess);
    EXPECT_EQ(folder.names(), std::vector<std::string> { "from" });
}

TEST(SessionFolder, VanishesHoweverItsOwnerEnds)
{
    for (const int signal : { 0, SIGTERM, SIGKILL }) {
        int ends[2];
        ASSERT_EQ(pipe(ends), 0);
        const pid_t child = fork();
        if (child == 0) {
            {
                const SessionFolder folder("vkpt-test-");
                std::filesystem::create_directories(folder.path() / "a/b");
                const std::string name = folder.path().string();
                if (write(ends[1], name.data(), name.size()) < 0)
                    _exit(1);
                if (signal)
                    raise(signal);
            }
            _exit(0);
        }
        char name[256] = {};
        ASSERT_GT(::read(ends[0], name, sizeof name - 1), 0);
        waitpid(child, nullptr, 0);
        close(ends[1]);
        // The folder's cleaner has nothing open but its own pipe, else this would wait for it.
        EXPECT_EQ(::read(ends[0], name + 200, 1), 0);
        close(ends[0]);
        while (std::filesystem::exists(name)) // the test's own limit ends it
            usleep(1000);
    }
}

void expect_refused(const std::filesystem::path& path, const std::string& part)
{
    const PrivateFolder folder = open_private_folder(path);
    EXPECT_EQ(folder.path, "");
    EXPECT_NE(folder.problem.find(part), std::string::npos) << "\"" << part << "\" is not in: " << folder.problem;
}

TEST(PrivateFolder, IsOursAlone)
{
    const ScratchFolder folder;
    const std::filesystem::path path = folder.path() / "on/the/way/vkpt";
    EXPECT_EQ(open_private_folder(path).path, path);
    EXPECT_EQ(permissions_of(path), 0700);
    EXPECT_EQ(permissions_of(path.parent_path()), 0700);
    EXPECT_EQ(open_private_folder(path).path, path) << "the second time";
    chmod(path.c_str(), 0755);
    EXPECT_EQ(open_private_folder(path).path, path) << "others may look";
    for (const mode_t mode : { 0770, 0707 }) {
        chmod(path.c_str(), mode);
        expect_refused(path, "chmod go-w");
    }
    chmod(path.c_str(), 0700);
    std::filesystem::create_directory_symlink(path, folder.path() / "link");
    expect_refused(folder.path() / "link", "symbolic link");
    folder.write("file", "");
    expect_refused(folder.path() / "file", "no folder");
    expect_refused(folder.path() / "file/below", "cannot make");
    chmod(path.c_str(), 0777);
    expect_refused(path / "below", "by everybody");
}

TEST(PrivateFolder, IsNotTakenOverFromAnotherUser)
{
    const ScratchFolder folder;
    if (geteuid() != 0) {
        expect_refused("/usr", "belongs to user 0");
        return;
    }
    const std::filesystem::path other = folder.path() / "other";
    std::filesystem::create_directory(other);
    ASSERT_EQ(chown(other.c_str(), 12345, 12345), 0);
    expect_refused(other, "belongs to user 12345");
    expect_refused(other / "vkpt", "belongs to user 12345");
}

// Sets a variable of the environment, or takes it away, for a while.
class Variable {
public:
    Variable(const char* name, const char* value)
        : name_(name)
        , before_(std::getenv(name) ? std::optional<std::string>(std::getenv(name)) : std::nullopt)
    {
        value ? setenv(name, value, 1) : unsetenv(name);
    }
    ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    const char* name_;
    std::optional<std::string> before_;
};

TEST(PrivateFolder, CacheFollowsTheXdgSpecification)
{
    const ScratchFolder folder;
    const std::string home = folder.path() / "home", cache = folder.path() / "cache";
    const Variable a("HOME", home.c_str()), b("XDG_CACHE_HOME", cache.c_str());
    EXPECT_EQ(open_cache_folder().path, cache + "/vkpt");
    {
        const Variable relative("XDG_CACHE_HOME", "cache");
        EXPECT_EQ(open_cache_folder().path, home + "/.cache/vkpt");
    }
    const Variable none("XDG_CACHE_HOME", nullptr), nobody("HOME", nullptr);
    const PrivateFolder without = open_cache_folder();
    EXPECT_EQ(without.path, "") << "once a known name among the temporary files";
    EXPECT_NE(without.problem.find("$HOME"), std::string::npos) << without.problem;
}

} // namespace
} // namespace vkpt::tests
