// SPDX-License-Identifier: GPL-2.0-or-later
// Photographs' names, and that nothing is written over or beyond its limit.
#include "ref_vkpt/files/output_folder.hpp"
#include "ref_vkpt/photo/photo_files.hpp"
#include "tests/client/run_program.hpp"

#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr uint64_t much = 1 << 20;

Photograph make_photo()
{
    Photograph photo;
    photo.shown = { 2, 1, { { 1, 2, 3, 255 }, { 4, 5, 6, 255 } } };
    photo.width = 2;
    photo.height = 1;
    photo.radiance = { 0, 1, 2, 3, 4, 5 };
    return photo;
}

// The reason; "": it was saved.
std::string save(const ScratchFolder& folder, const std::string& name, uint64_t max_bytes = much)
try {
    save_photograph(folder.path(), name, make_photo(), max_bytes);
    return "";
} catch (const FileError& error) {
    return error.what();
}

TEST(PhotoFiles, CountUpAndReplaceNothing)
{
    const ScratchFolder folder;
    EXPECT_EQ(save(folder, ""), "");
    EXPECT_EQ(save(folder, ""), "");
    for (const char* name : { "photo0001.png", "photo0001.exr", "photo0002.png", "photo0002.exr" })
        EXPECT_TRUE(std::filesystem::exists(folder.path() / "vkpt/photos" / name)) << name;
    EXPECT_NE(save(folder, "photo0002").find("is there already"), std::string::npos);
    folder.write("vkpt/photos/mine.exr", "a picture of somebody's");
    EXPECT_NE(save(folder, "mine").find("is there already"), std::string::npos);
    EXPECT_EQ(folder.read("vkpt/photos/mine.exr"), "a picture of somebody's");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "vkpt/photos/mine.png"));
    std::filesystem::create_symlink("nowhere", folder.path() / "vkpt/photos/link.png");
    EXPECT_NE(save(folder, "link").find("is there already"), std::string::npos);
}

TEST(PhotoFiles, HaveNamesAndNoPaths)
{
    const ScratchFolder folder;
    for (const char* name : { "../a", "a/b", "a.png", "/a", "..", "a b" })
        EXPECT_NE(save(folder, name).find("only letters, digits"), std::string::npos) << name;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "vkpt"));
}

TEST(PhotoFiles, StayWithinTheirLimit)
{
    const ScratchFolder folder;
    EXPECT_NE(save(folder, "a", 100).find("move some away"), std::string::npos);
    EXPECT_EQ(save(folder, "a"), "");
}

} // namespace
} // namespace vkpt::tests
