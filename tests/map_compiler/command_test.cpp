// SPDX-License-Identifier: GPL-2.0-or-later
// The command line: exit status, files, messages.
#include "common/read_text.hpp"
#include "tests/map_compiler/map_text.hpp"
#include "tests/map_compiler/texture_folder.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/wait.h>

namespace vkpt::tests {

namespace fs = std::filesystem;

namespace {

void write_text(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

class Command : public testing::Test {
protected:
    struct Result {
        int status;
        std::string messages;
    };
    Result run(const std::string& arguments) const
    {
        const fs::path log = folder_.root() / "log";
        const std::string command = std::string(VKPT_MAP_PROGRAM) + " " + arguments + " > '" + log.string() + "' 2>&1";
        const int status = std::system(command.c_str());
        return { WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(log) };
    }
    std::string path(const std::string& name) const { return (folder_.root() / name).string(); }

    TextureFolder folder_;
};

TEST_F(Command, CompilesAMap)
{
    write_text(path("two.map"), two_rooms::text());
    const Result result
        = run(path("two.map") + " -o " + path("two.bsp") + " --textures " + folder_.textures().string());
    EXPECT_EQ(result.status, 0) << result.messages;
    const std::string file = read_text(path("two.bsp"));
    const formats::Bsp bsp = formats::read_bsp(std::as_bytes(std::span(file)), "two.bsp");
    EXPECT_GT(bsp.cluster_count, 0);
    EXPECT_FALSE(bsp.lighting.empty());
}

TEST_F(Command, WritesQbspWhenAsked)
{
    write_text(path("two.map"), two_rooms::text());
    const std::string arguments = path("two.map") + " --textures " + folder_.textures().string() + " -o ";
    ASSERT_EQ(run(arguments + path("narrow.bsp")).status, 0);
    const Result result = run(arguments + path("wide.bsp") + " --qbsp");
    EXPECT_EQ(result.status, 0) << result.messages;
    const std::string narrow_file = read_text(path("narrow.bsp")), wide_file = read_text(path("wide.bsp"));
    EXPECT_TRUE(wide_file.starts_with("QBSP"));
    formats::Bsp narrow = formats::read_bsp(std::as_bytes(std::span(narrow_file)), "two.bsp");
    EXPECT_EQ(narrow.format, formats::BspFormat::ibsp);
    narrow.format = formats::BspFormat::qbsp;
    const std::vector<std::byte> widened = formats::write_bsp(narrow);
    EXPECT_EQ(wide_file, std::string(reinterpret_cast<const char*>(widened.data()), widened.size()));
}

TEST_F(Command, LeavesOutLightAndVisibilityWhenAsked)
{
    write_text(path("two.map"), two_rooms::text());
    const Result result = run(path("two.map") + " -o " + path("two.bsp") + " --no-light --no-vis");
    EXPECT_EQ(result.status, 0) << result.messages;
    const std::string file = read_text(path("two.bsp"));
    const formats::Bsp bsp = formats::read_bsp(std::as_bytes(std::span(file)), "two.bsp");
    EXPECT_EQ(bsp.cluster_count, 0);
    EXPECT_TRUE(bsp.lighting.empty());
}

TEST_F(Command, LeakIsExitOneWithAPointFile)
{
    write_text(path("leak.map"), open_room_text());
    const Result result = run(path("leak.map") + " -o " + path("leak.bsp"));
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.messages.find("info_player_start"), std::string::npos) << result.messages;
    EXPECT_FALSE(fs::exists(path("leak.bsp")));
    const std::string points = read_text(path("leak.pts"));
    EXPECT_GE(std::count(points.begin(), points.end(), '\n'), 2);
    EXPECT_TRUE(points.ends_with("0.00 0.00 24.00\n")) << points;
}

TEST_F(Command, ErrorsNameFileAndLine)
{
    write_text(path("bad.map"), "{\n\"classname\" \"worldspawn\"\n{\nrubbish\n}\n}\n");
    const Result result = run(path("bad.map") + " -o " + path("bad.bsp"));
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.messages.find("bad.map:4: "), std::string::npos) << result.messages;
    EXPECT_EQ(run(path("absent.map") + " -o " + path("bad.bsp")).status, 1);
    write_text(path("two.map"), two_rooms::text());
    EXPECT_EQ(run(path("two.map") + " --no-light -o " + path("no/such/folder.bsp")).status, 1);
}

TEST_F(Command, WrongUseIsExitTwo)
{
    EXPECT_EQ(run("").status, 2);
    EXPECT_EQ(run("a.map").status, 2);
    EXPECT_EQ(run("a.map -o b.bsp --light-threads many").status, 2);
    EXPECT_EQ(run("--help").status, 0);
}

} // namespace

} // namespace vkpt::tests
