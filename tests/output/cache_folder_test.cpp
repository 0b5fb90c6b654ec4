// SPDX-License-Identifier: GPL-2.0-or-later
// What drivers run comes from a folder that nobody else can write to.
#include "ref_vkpt/files/cache_folder.hpp"
#include "tests/client/run_program.hpp"

#include <cstdlib>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vkpt::tests {
namespace {

namespace fs = std::filesystem;

class CacheFolderTest : public testing::Test {
protected:
    CacheFolderTest()
    {
        for (const char* name : names)
            if (const char* text = std::getenv(name))
                saved.emplace_back(name, text);
        for (const char* name : names)
            unsetenv(name);
    }
    ~CacheFolderTest() override
    {
        for (const char* name : names)
            unsetenv(name);
        for (const auto& [name, text] : saved)
            setenv(name.c_str(), text.c_str(), 1);
    }

    void set(const char* name, const fs::path& path) const { setenv(name, path.c_str(), 1); }
    void expect_none(const char* part) const
    {
        const CacheFolder found = find_cache_folder();
        EXPECT_EQ(found.path, "");
        EXPECT_NE(found.reason.find(part), std::string::npos) << found.reason;
    }

    static constexpr const char* names[] = { "VKPT_CACHE_DIR", "XDG_CACHE_HOME", "HOME" };
    std::vector<std::pair<std::string, std::string>> saved;
    ScratchFolder folder;
};

TEST_F(CacheFolderTest, IsPrivateAndBelowTheUsersCaches)
{
    set("HOME", folder.path());
    EXPECT_EQ(find_cache_folder().path, folder.path() / ".cache/ref_vkpt");
    struct stat status { };
    ASSERT_EQ(stat((folder.path() / ".cache/ref_vkpt").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0700u);
    set("XDG_CACHE_HOME", folder.path() / "xdg");
    EXPECT_EQ(find_cache_folder().path, folder.path() / "xdg/ref_vkpt");
    set("XDG_CACHE_HOME", "relative");
    EXPECT_EQ(find_cache_folder().path, folder.path() / ".cache/ref_vkpt");
    set("VKPT_CACHE_DIR", folder.path() / "chosen");
    EXPECT_EQ(find_cache_folder().path, folder.path() / "chosen");
    EXPECT_EQ(find_cache_folder().reason, "");
}

TEST_F(CacheFolderTest, IsDoneWithoutWhereNothingSaysWhere) { expect_none("HOME"); }

TEST_F(CacheFolderTest, IsNoLinkAndNoFile)
{
    fs::create_directory(folder.path() / "real");
    fs::create_directory_symlink(folder.path() / "real", folder.path() / "link");
    set("VKPT_CACHE_DIR", folder.path() / "link");
    expect_none("link");
    set("VKPT_CACHE_DIR", folder.path() / "link/");
    expect_none("link");
    folder.write("file", "");
    set("VKPT_CACHE_DIR", folder.path() / "file");
    expect_none("no folder");
}

TEST_F(CacheFolderTest, IsNotWritableByOthers)
{
    set("VKPT_CACHE_DIR", folder.path() / "cache");
    ASSERT_NE(find_cache_folder().path, "");
    for (const mode_t mode : { 0770u, 0707u, 01777u }) {
        ASSERT_EQ(chmod((folder.path() / "cache").c_str(), mode), 0);
        expect_none("others");
    }
    ASSERT_EQ(chmod((folder.path() / "cache").c_str(), 0755), 0);
    EXPECT_NE(find_cache_folder().path, "") << "others may read";
}

TEST_F(CacheFolderTest, BelongsToTheUser)
{
    fs::path others = "/usr"; // root's
    if (geteuid() == 0) {
        others = folder.path() / "others";
        fs::create_directory(others);
        ASSERT_EQ(chown(others.c_str(), 65534, 65534), 0);
    }
    set("VKPT_CACHE_DIR", others);
    expect_none("another user");
}

} // namespace
} // namespace vkpt::tests
