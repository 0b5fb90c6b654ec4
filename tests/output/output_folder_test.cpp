// SPDX-License-Identifier: GPL-2.0-or-later
// Nothing is written outside of the module's folders, through links, or over what is not the module's.
#include "ref_vkpt/files/output_folder.hpp"
#include "tests/client/run_program.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace vkpt::tests {
namespace {

namespace fs = std::filesystem;

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

class Output : public testing::Test {
protected:
    OutputFolder open() const { return OutputFolder(folder.path(), { "vkpt", "bench" }); }
    // The reason; "": it was written.
    std::string write(const std::string& name, std::string_view text, std::string_view mark = "ours:") const
    try {
        open().write(name, bytes_of(text), mark);
        return "";
    } catch (const FileError& error) {
        return error.what();
    }

    ScratchFolder folder;
};

TEST(PlainName, IsNoPath)
{
    for (const char* name : { "a", "shots", "a-b_C9", "-", "0" })
        EXPECT_TRUE(is_plain_name(name)) << name;
    for (const char* name :
        { "", ".", "..", "../a", "a/b", "/a", "a\\b", "a.cfg", "a b", "a\n", "\xc3\xa4", "~", "$HOME", "C:" })
        EXPECT_FALSE(is_plain_name(name)) << name;
    EXPECT_FALSE(is_plain_name(std::string_view("a\0b", 3)));
    EXPECT_TRUE(is_plain_name(std::string(64, 'a')));
    EXPECT_FALSE(is_plain_name(std::string(65, 'a')));
}

TEST_F(Output, MakesItsFoldersAndReplacesItsOwnFiles)
{
    EXPECT_EQ(write("a.json", "ours: first"), "");
    EXPECT_EQ(write("a.json", "ours: second, and longer"), "");
    EXPECT_EQ(folder.read("vkpt/bench/a.json"), "ours: second, and longer");
    EXPECT_EQ(open().bytes(), 24u);
    EXPECT_EQ(open().path(), folder.path() / "vkpt/bench");
}

TEST_F(Output, LeavesForeignFilesAlone)
{
    open();
    for (const char* text : { "bind x quit", "", "our", " ours:" }) {
        folder.write("vkpt/bench/a.json", text);
        const std::string reason = write("a.json", "ours: new");
        EXPECT_NE(reason.find("vkpt/bench/a.json"), std::string::npos) << reason;
        EXPECT_EQ(folder.read("vkpt/bench/a.json"), text);
    }
    folder.write("vkpt/bench/a.json", "ours: old");
    EXPECT_NE(write("a.json", "ours: new", ""), "") << "without a mark nothing is replaced";
    EXPECT_EQ(folder.read("vkpt/bench/a.json"), "ours: old");
    fs::create_directory(folder.path() / "vkpt/bench/b.json");
    EXPECT_NE(write("b.json", "ours: new"), "");
    ASSERT_EQ(mkfifo((folder.path() / "vkpt/bench/c.json").c_str(), 0600), 0);
    EXPECT_NE(write("c.json", "ours: new"), "") << "or it would wait for ever";
}

TEST_F(Output, FollowsNoLinkToAFile)
{
    open();
    folder.write("victim", "ours: victim");
    fs::create_symlink(folder.path() / "victim", folder.path() / "vkpt/bench/a.json");
    EXPECT_NE(write("a.json", "ours: new"), "");
    fs::create_symlink(folder.path() / "victim", folder.path() / "vkpt/bench/.b.json.part");
    EXPECT_EQ(write("b.json", "ours: new"), "") << "what a killed run left is no hindrance";
    EXPECT_EQ(folder.read("victim"), "ours: victim");
}

TEST_F(Output, FollowsNoLinkToAFolder)
{
    fs::create_directories(folder.path() / "elsewhere/bench");
    fs::create_directory_symlink(folder.path() / "elsewhere", folder.path() / "vkpt");
    EXPECT_NE(write("a.json", "ours: new"), "");
    fs::remove(folder.path() / "vkpt");
    fs::create_directory(folder.path() / "vkpt");
    fs::create_directory_symlink(folder.path() / "elsewhere", folder.path() / "vkpt/bench");
    EXPECT_NE(write("a.json", "ours: new"), "");
    EXPECT_TRUE(fs::is_empty(folder.path() / "elsewhere/bench"));
    EXPECT_FALSE(fs::exists(folder.path() / "elsewhere/a.json"));
}

TEST_F(Output, NewFoldersAreNew)
{
    fs::create_directories(folder.path() / "vkpt/bench/shots-2");
    const OutputFolder first = open().make_new("shots"), second = open().make_new("shots");
    EXPECT_EQ(first.path().filename(), "shots");
    EXPECT_EQ(second.path().filename(), "shots-3");
    first.write("a", bytes_of("1"));
    second.write("a", bytes_of("22"));
    EXPECT_EQ(folder.read("vkpt/bench/shots/a"), "1");
    EXPECT_EQ(folder.read("vkpt/bench/shots-3/a"), "22");
    EXPECT_EQ(open().bytes(), 3u);
    EXPECT_GT(open().free_bytes(), 0u);
}

TEST_F(Output, SaysWhereItCannotWrite)
{
    folder.write("vkpt", "a file");
    const std::string reason = write("a.json", "ours: new");
    EXPECT_NE(reason.find((folder.path() / "vkpt").string()), std::string::npos) << reason;
}

} // namespace
} // namespace vkpt::tests
