// SPDX-License-Identifier: GPL-2.0-or-later
// Shaders that are edited while the module runs (pt_shader_dir).
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <thread>

namespace vkpt::tests {
namespace {

namespace fs = std::filesystem;

class ShaderReload : public testing::Test {
protected:
    ShaderReload()
        : shaders_(fs::canonical(folder_.path()) / "shaders")
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("lamp", white_index);
        formats::IndexedImage font { 128, 128, std::vector<uint8_t>(128 * 128, white_index), test_palette() };
        folder_.add("pics/conchars.pcx", formats::write_pcx(font));
        MapBuilder map;
        map.add_lit_room("wall");
        folder_.add_map("room", map.finish());
        fs::copy(VKPT_SHADERS, shaders_, fs::copy_options::recursive);
    }
    void start(const std::string& shader_folder)
    {
        session_ = std::make_unique<Session>(folder_,
            CvarList { { "pt_shader_dir", shader_folder }, { "pt_bloom", "0" }, { "pt_bounces", "0" },
                { "pt_exposure", "0.2" } },
            glm::ivec2(400, 200));
        session_->load_map("room");
        session_->look({ -100, 0, 50 }, { 100, 0, 50 });
    }
    // In a file below shaders/.
    void replace(const std::string& name, const std::string& before, const std::string& after) const
    {
        std::ifstream file(shaders_ / name);
        std::string text(std::istreambuf_iterator<char>(file), {});
        const size_t place = text.find(before);
        ASSERT_NE(place, std::string::npos) << name;
        std::ofstream(shaders_ / name) << text.replace(place, before.size(), after);
    }
    std::vector<formats::Rgba8> picture()
    {
        session_->draw(2); // the first takes up the pipelines that are looked at before the second
        return session_->capture_display().pixels;
    }
    std::vector<formats::Rgba8> picture_after_command()
    {
        session_->host().run_text("reload_shader");
        return picture();
    }

    static constexpr const char *shown = "return encode_display(display, vec3(1.0)) + dither / 255.0;",
                                *red = "return vec3(1.0, 0.0, 0.0);";

    GameFolder folder_;
    fs::path shaders_;
    std::unique_ptr<Session> session_;
};

TEST_F(ShaderReload, EditsShowByThemselvesAndByCommand)
{
    start(shaders_.string());
    const std::vector<formats::Rgba8> first = picture();
    EXPECT_FALSE(session_->has_line("shaders changed")) << "the folder has what the build had";
    replace("tone_map.comp", shown, red);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    EXPECT_EQ(picture(), std::vector(first.size(), formats::Rgba8 { 255, 0, 0, 255 }));
    EXPECT_TRUE(session_->has_line("1 shaders changed, 1 compiled"));
    replace("tone_map.comp", red, shown);
    EXPECT_EQ(picture_after_command(), first);
    EXPECT_TRUE(session_->has_line("all shaders in use are those of " + shaders_.string()));
}

// A file that many shaders include. The message is on the console and over the picture.
TEST_F(ShaderReload, ErrorsAreShownAndTheOldShaderStays)
{
    start(shaders_.string());
    const std::vector<formats::Rgba8> first = picture();
    replace("lib/image.glsl", "vec3 before =", "vec3 befor =");
    const std::vector<formats::Rgba8> broken = picture_after_command();
    EXPECT_TRUE(session_->has_line("lib/image.glsl:"));
    EXPECT_TRUE(session_->has_line("undeclared identifier"));
    EXPECT_TRUE(std::ranges::equal(first.end() - 400 * 20, first.end(), broken.end() - 400 * 20, broken.end()))
        << "below the message";
    EXPECT_GT(std::ranges::count(broken, formats::Rgba8 { 255, 255, 255, 255 }), 2000) << "the message";
    EXPECT_EQ(std::ranges::count(first, formats::Rgba8 { 255, 255, 255, 255 }), 0);
    replace("lib/image.glsl", "vec3 befor =", "vec3 before =");
    EXPECT_EQ(picture_after_command(), first);
}

TEST_F(ShaderReload, NothingOutsideTheFolderIsRead)
{
    std::ofstream(shaders_ / "../outside.glsl") << "const float outside = 1.0;\n";
    start(shaders_.string());
    const std::vector<formats::Rgba8> first = picture();
    replace("tone_map.comp", shown, red);
    replace(
        "tone_map.comp", "#include \"lib/frame.glsl\"", "#include \"lib/frame.glsl\"\n#include \"../outside.glsl\"");
    const std::vector<formats::Rgba8> refused = picture_after_command();
    EXPECT_TRUE(session_->has_line("outside.glsl is not in " + shaders_.string()));
    EXPECT_EQ(refused.back(), first.back());
}

TEST_F(ShaderReload, MissingCompilerIsNamed)
{
    start(shaders_.string());
    picture();
    const std::string path = std::getenv("PATH");
    setenv("PATH", folder_.path().c_str(), 1);
    replace("tone_map.comp", shown, red);
    const formats::Rgba8 last = picture_after_command().back();
    setenv("PATH", path.c_str(), 1);
    EXPECT_TRUE(session_->has_line("install the package glslang-tools"));
    EXPECT_NE(last, (formats::Rgba8 { 255, 0, 0, 255 }));
}

// As a server could try.
TEST_F(ShaderReload, TheFolderIsChosenAtTheStartAlone)
{
    replace("tone_map.comp", shown, red);
    start("");
    const std::vector<formats::Rgba8> first = picture();
    session_->host().run_text("set pt_shader_dir " + shaders_.string());
    session_->set("pt_shader_dir", shaders_.string());
    EXPECT_EQ(picture_after_command(), first);
    EXPECT_TRUE(session_->has_line("shaders are those of the build"));
    EXPECT_NE(first.back(), (formats::Rgba8 { 255, 0, 0, 255 }));
}

TEST_F(ShaderReload, MissingFolderIsTold)
{
    start((shaders_ / "missing").string());
    picture();
    EXPECT_TRUE(session_->has_line("missing\" is not a folder"));
}

} // namespace
} // namespace vkpt::tests
