// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/analysis/display.hpp"
#include "client/host/errors.hpp"
#include "tests/client/run_program.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace vkpt::tests {
namespace {

using namespace vkpt::analysis;

std::string text_of(const std::vector<std::byte>& bytes)
{
    return { reinterpret_cast<const char*>(bytes.data()), bytes.size() };
}

const std::vector<float> sample { 0, 0.5f, 1, 2, 3, 4, 5, 6, 7, 8, 9, 1e6f }; // 2 x 2

std::string failure_of(const std::filesystem::path& path)
{
    try {
        read_image(path);
    } catch (const client::Failure& failure) {
        return failure.what();
    }
    return "(no failure)";
}

TEST(ImageFile, ReadsWhatWeWrite)
{
    const ScratchFolder folder;
    folder.write("a.pfm", text_of(formats::write_pfm(2, 2, sample)));
    folder.write("a.exr", text_of(formats::write_exr(2, 2, sample)));
    for (const char* name : { "a.pfm", "a.exr" }) {
        const LinearImage image = read_image(folder.path() / name);
        EXPECT_EQ(image.width, 2) << name;
        EXPECT_EQ(image.rgb, sample) << name;
        EXPECT_FALSE(image.is_display) << name;
    }
    const formats::Image picture { 2, 1, { { 255, 0, 128, 255 }, { 1, 2, 3, 255 } } };
    folder.write("a.png", text_of(formats::write_png(picture)));
    const LinearImage image = read_image(folder.path() / "a.png");
    EXPECT_TRUE(image.is_display);
    EXPECT_EQ(encode_display(image).pixels, picture.pixels);
}

TEST(ImageFile, ReadsGreyAndBigEndianPfm)
{
    const ScratchFolder folder;
    folder.write("a.pfm", std::string("Pf 1 2\n1.0\n") + std::string("\x3f\x80\0\0\x40\0\0\0", 8));
    const LinearImage image = read_image(folder.path() / "a.pfm");
    EXPECT_EQ(image.rgb, (std::vector<float> { 2, 2, 2, 1, 1, 1 }));
}

TEST(ImageFile, SaysWhatIsWrong)
{
    const ScratchFolder folder;
    const std::string pfm = text_of(formats::write_pfm(2, 2, sample));
    folder.write("short.pfm", pfm.substr(0, pfm.size() - 1));
    folder.write("header.pfm", "PF 2");
    folder.write("empty.pfm", "");
    folder.write("blank.pfm", "PF \n ");
    folder.write("word.pfm", "PF two 2 -1\n");
    folder.write("huge.pfm", "PF 99999999999 2 -1\n");
    folder.write("text.pfm", "what is this? ");
    folder.write("text.png", "what is this?");
    folder.write("text.exr", "what is this?");
    folder.write("picture.gif", "GIF89a");
    std::vector<float> broken = sample;
    broken[3] = std::numeric_limits<float>::quiet_NaN();
    folder.write("nan.pfm", text_of(formats::write_pfm(2, 2, broken)));
    const std::pair<const char*, const char*> cases[] = { { "short.pfm", "bytes" }, { "header.pfm", "header" },
        { "empty.pfm", "header" }, { "blank.pfm", "header" }, { "word.pfm", "two" }, { "huge.pfm", "99999999999" },
        { "text.pfm", "PF" }, { "text.png", "text.png" }, { "text.exr", "text.exr" }, { "picture.gif", ".exr" },
        { "nan.pfm", "1 of 12" }, { "nowhere.exr", "No such file" }, { "nowhere.png", "No such file" } };
    for (const auto& [name, part] : cases) {
        const std::string failure = failure_of(folder.path() / name);
        EXPECT_NE(failure.find(part), std::string::npos) << name << ": " << failure;
        EXPECT_NE(failure.find(name), std::string::npos) << failure;
    }
    std::filesystem::create_directory(folder.path() / "folder.png");
    EXPECT_NE(failure_of(folder.path() / "folder.png").find("folder"), std::string::npos);
}

} // namespace
} // namespace vkpt::tests
