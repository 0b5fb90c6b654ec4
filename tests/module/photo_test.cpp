// SPDX-License-Identifier: GPL-2.0-or-later
// Photo mode: the camera's pictures are those of a player who stands there, leaving it leaves nothing behind, and
// photographs are written where, and only where, they should be.
#include "formats/model.hpp"
#include "shaders/shared/scene.h"
#include "tests/module/cube_room.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <set>
#include <unistd.h>

namespace vkpt::tests {
namespace {

namespace fs = std::filesystem;

class PhotoMode : public CubeRoomTest {
protected:
    void start(const CvarList& cvars = {}, glm::ivec2 size = { 64, 48 })
    {
        CubeRoomTest::start(cvars, size);
        session_->draw();
    }

    // Where the last line that says so has written to.
    fs::path written(std::string_view ending) const
    {
        constexpr std::string_view words = "pt_photo: wrote ";
        fs::path found;
        for (const std::string& line : session_->lines())
            if (line.starts_with(words) && line.ends_with(ending))
                found = line.substr(words.size());
        return found;
    }

    static std::vector<std::byte> read_file(const fs::path& path)
    {
        std::ifstream stream(path, std::ios::binary);
        const std::string text { std::istreambuf_iterator<char>(stream), {} };
        const auto bytes = std::as_bytes(std::span(text));
        return { bytes.begin(), bytes.end() };
    }
};

class PhotoLimitLong : public PhotoMode { };

TEST_F(PhotoMode, ShowsWhatAPlayerThereWouldSee)
{
    start();
    constexpr glm::vec3 eye { 60, -90, 100 }, target { 30, 20, 10 };
    session_->look(eye, target, 70);
    const auto& angles = session_->view.view_angles;
    const std::string look = fmt::format("pt_photo look {} {} 0", angles[0], angles[1]);
    const Radiance expected = session_->accumulate(20);
    session_->set("pt_accumulate", 0);
    session_->look(players_eye, players_target);
    session_->draw();
    run("pt_photo");
    session_->draw(2);
    run("pt_photo at 60 -90 100");
    run(look);
    run("pt_photo fov 70");
    session_->draw(20);
    EXPECT_EQ(session_->extension().accumulated_frames(), 20u);
    EXPECT_TRUE(session_->capture() == expected);
}

// Bit for bit, with the exposure that the eye had adapted to; and so the second time.
TEST_F(PhotoMode, LeavingItLeavesNothingBehind)
{
    Session::end_idle(); // whose exposure may have far to go until it rests
    start();
    session_->set("pt_exposure", 0);
    session_->draw(1500);
    const formats::Image before = session_->capture_display();
    const Radiance light = session_->capture();
    session_->draw();
    ASSERT_EQ(session_->capture_display().pixels, before.pixels) << "the exposure has not come to rest";
    std::vector<formats::Rgba8> photos[2];
    for (std::vector<formats::Rgba8>& photo : photos) {
        run("pt_photo");
        session_->draw();
        run("pt_photo at 0 0 120");
        run("pt_photo look 90 0");
        run("pt_photo exposure 3");
        session_->draw(20);
        photo = session_->capture_display().pixels;
        EXPECT_NE(photo, before.pixels);
        run("pt_photo off");
        session_->draw();
        EXPECT_EQ(session_->capture_display().pixels, before.pixels);
        EXPECT_TRUE(session_->capture() == light);
    }
    EXPECT_EQ(photos[1], photos[0]) << "its own exposure does not begin anew";
}

// What the engine shows meanwhile does not count, and a view is averaged until the camera changes.
TEST_F(PhotoMode, KeepsTheViewThatItBeganWith)
{
    start();
    run("pt_photo");
    session_->draw(8);
    const Radiance kept = session_->capture();
    EXPECT_EQ(session_->extension().accumulated_frames(), 8u);
    run("pt_photo move 5");
    session_->draw();
    EXPECT_EQ(session_->extension().accumulated_frames(), 1u);
    run("pt_photo home");
    session_->look({ 0, 0, 100 }, { 10, 0, 0 });
    cube_.origin[2] = 90;
    session_->draw(8);
    EXPECT_TRUE(session_->capture() == kept);
}

TEST_F(PhotoMode, BrightensWithoutANewPicture)
{
    start({}, { 320, 240 }); // so that most of it lies beside the panel
    run("pt_photo");
    session_->draw(8);
    const auto lower_right = [&] {
        const formats::Image image = session_->capture_display();
        double sum = 0;
        for (int y = 160; y < 240; y++)
            for (int x = 200; x < 320; x++)
                sum += image.at(x, y).g;
        return sum;
    };
    const double before = lower_right();
    run("pt_photo exposure 1");
    session_->draw();
    EXPECT_EQ(session_->extension().accumulated_frames(), 9u);
    EXPECT_GT(lower_right(), 1.15 * before);
}

TEST_F(PhotoMode, FocusesOnWhatTheCrosshairShows)
{
    start();
    run("pt_photo");
    session_->draw();
    run("pt_photo at -60 0 30");
    run("pt_photo look 0 0");
    run("pt_photo focus");
    const auto focus = [&] { return std::stod(session_->host().cvars().find("pt_focus")->text); };
    EXPECT_NEAR(focus(), 92, 0.01) << "the cube's side";
    run("pt_photo look 0 90");
    session_->draw();
    EXPECT_NEAR(focus(), 92, 0.01) << "it was fixed";
    run("pt_photo focus auto");
    run("pt_photo aperture 4");
    session_->draw(2);
    EXPECT_NEAR(focus(), 128, 0.01) << "the wall's";
    run("pt_photo look 0 0");
    session_->draw(2);
    EXPECT_NEAR(focus(), 92, 0.01);
}

TEST_F(PhotoMode, ShowsThePlayerAndNotTheWeaponInView)
{
    start();
    std::array<engine::Entity, 2> entities { cube_, cube_ };
    entities[0].flags = engine::RF_WEAPONMODEL;
    entities[1].flags = engine::RF_VIEWERMODEL;
    session_->view.entities = entities.data();
    session_->view.entity_count = 2;
    const auto count = [&](uint32_t mask) {
        SceneContents contents;
        EXPECT_TRUE(session_->extension().read_scene(&contents));
        return std::count_if(contents.triangles, contents.triangles + contents.triangle_count,
            [&](const SceneTriangle& triangle) { return (triangle.ray_mask & mask) != 0; });
    };
    session_->draw();
    const auto of_the_map = count(shared::MASK_OPAQUE);
    EXPECT_EQ(count(shared::MASK_VIEW_WEAPON), 12);
    EXPECT_EQ(count(shared::MASK_OWN_BODY), 12);
    run("pt_photo");
    session_->draw();
    EXPECT_EQ(count(shared::MASK_VIEW_WEAPON), 0);
    EXPECT_EQ(count(shared::MASK_OWN_BODY), 0);
    EXPECT_EQ(count(shared::MASK_OPAQUE), of_the_map + 12);
    run("pt_photo off");
    session_->draw();
    EXPECT_EQ(count(shared::MASK_VIEW_WEAPON), 12);
}

TEST_F(PhotoMode, SavesThePictureAloneAndNeverOverAnother)
{
    start({ { "pt_photo_save", "1" } }, { 320, 240 });
    run("pt_photo");
    session_->draw();
    const std::string name = fmt::format("castle{}", getpid()); // runs share the folder
    run(fmt::format("pt_photo save {} 6", name));
    session_->draw(4);
    EXPECT_EQ(written(".png"), "");
    session_->draw();
    const fs::path png = written("/vkpt/photos/" + name + ".png"), exr = written("/vkpt/photos/" + name + ".exr");
    ASSERT_FALSE(png.empty() || exr.empty());
    EXPECT_EQ(session_->extension().accumulated_frames(), 6u);
    // The frame with the photograph has nothing over it; the others have the panel.
    const formats::Image alone = session_->capture_display();
    EXPECT_EQ(formats::read_common_image(read_file(png), "castle.png").pixels, alone.pixels);
    EXPECT_GT(fs::file_size(exr), 1000u);
    session_->draw();
    EXPECT_NE(session_->capture_display().pixels, alone.pixels);
    run("pt_photo save " + name);
    session_->draw(2);
    EXPECT_TRUE(session_->has_line(name + " is there already"));
    std::set<fs::path> files { png, exr };
    for (int i = 0; i < 2; i++) {
        run("pt_photo save");
        session_->draw(2);
        for (const char* ending : { ".png", ".exr" })
            EXPECT_TRUE(files.insert(written(ending)).second) << written(ending);
    }
    for (const fs::path& file : files)
        EXPECT_TRUE(fs::remove(file)) << file;
}

// Twice as wide as high, in the middle of the window; the rest of the window is not in the photograph.
TEST_F(PhotoMode, PhotographsAllAround)
{
    start({ { "pt_photo_save", "1" } }, { 64, 48 });
    run("pt_photo");
    session_->draw();
    run("pt_photo projection round");
    EXPECT_TRUE(session_->has_line("\"round\" is none of perspective, panini"));
    run("pt_photo projection equirectangular");
    session_->draw();
    run(fmt::format("pt_photo save around{} 4", getpid()));
    session_->draw(6);
    const fs::path png = written(".png"), exr = written(".exr");
    ASSERT_FALSE(png.empty() || exr.empty());
    const formats::Image shown = formats::read_common_image(read_file(png), "around.png");
    EXPECT_EQ(shown.width, 64);
    EXPECT_EQ(shown.height, 32);
    run("pt_photo projection panini");
    session_->draw();
    run("pt_photo fov 400");
    run("pt_photo info");
    EXPECT_TRUE(session_->has_line("fov 340.00"));
    run("pt_photo projection perspective");
    session_->draw();
    run("pt_photo info");
    EXPECT_TRUE(session_->has_line("fov 160.00"));
    for (const fs::path& file : { png, exr })
        EXPECT_TRUE(fs::remove(file)) << file;
}

TEST_F(PhotoMode, RefusesNamesThatArePaths)
{
    start({ { "pt_photo_save", "1" } });
    run("pt_photo");
    session_->draw();
    for (const char* name : { "../a", "/tmp/a", "a.png", "a/b", ".." }) {
        run(std::string("pt_photo save ") + name);
        EXPECT_TRUE(session_->has_line(std::string("\"") + name + "\" may have only letters")) << name;
    }
    session_->draw(3);
    EXPECT_EQ(written(""), "");
}

// Servers can run console commands.
TEST_F(PhotoMode, TheConsoleAloneWritesNothing)
{
    start();
    run("pt_photo");
    session_->draw();
    run("set pt_photo_save 1");
    run("pt_photo save castle");
    session_->draw(10);
    EXPECT_TRUE(session_->has_line("press Enter"));
    EXPECT_EQ(written(""), "");
}

// The engine's key sets the cvar, and so do its menus; those draw something, and this is no menu.
TEST_F(PhotoMode, BeginsAndEndsWithThePlayersPause)
{
    start();
    const auto is_on_with = [&](int paused) {
        session_->set("paused", paused);
        session_->draw(12);
        run("pt_photo info");
        return session_->lines().back().find("photo mode is off") == std::string::npos;
    };
    EXPECT_TRUE(is_on_with(1));
    EXPECT_FALSE(is_on_with(0));
    session_->set("pt_photo_on_pause", 0);
    session_->draw();
    EXPECT_FALSE(is_on_with(1));
    EXPECT_FALSE(is_on_with(0));
    run("pt_photo");
    EXPECT_TRUE(is_on_with(1));
    EXPECT_TRUE(is_on_with(0)) << "it was not the pause that began it";
}

TEST_F(PhotoMode, SaysWhatItDoesNotKnow)
{
    start();
    run("pt_photo move 10");
    EXPECT_TRUE(session_->has_line("photo mode is off"));
    run("pt_photo");
    session_->draw();
    run("pt_photo fly 3");
    EXPECT_TRUE(session_->has_line("there is no \"fly\""));
    run("pt_photo at 1 2");
    EXPECT_TRUE(session_->has_line("usage: pt_photo at X Y Z"));
    run("pt_photo fov wide");
    EXPECT_TRUE(session_->has_line("\"wide\" is no number"));
    run("pt_photo focus -3");
    EXPECT_TRUE(session_->has_line("\"-3\" is no number from 1 to 100000"));
    run("pt_photo save a 0");
    EXPECT_TRUE(session_->has_line("\"0\" is no number of samples"));
}

// Under the label "long": all of its samples. Then the picture is shown again, and no ray is traced.
TEST_F(PhotoLimitLong, TheLastSampleEndsThePicture)
{
    start({}, { 8, 6 });
    run("pt_photo");
    session_->draw(65535);
    EXPECT_EQ(session_->extension().accumulated_frames(), 65535u);
    const Radiance before = session_->capture();
    session_->draw();
    const Radiance last = session_->capture();
    EXPECT_FALSE(last == before);
    EXPECT_EQ(session_->extension().accumulated_frames(), 65536u);
    session_->extension().time_every_pass();
    session_->draw(3);
    EXPECT_EQ(session_->extension().accumulated_frames(), 65536u);
    EXPECT_TRUE(session_->capture() == last);
    const std::vector<std::string> passes = session_->timed_passes();
    EXPECT_EQ(std::ranges::count(passes, "primary_visibility"), 0);
    EXPECT_EQ(std::ranges::count(passes, "tone_map"), 1);
    run("pt_photo move 1");
    session_->draw();
    EXPECT_EQ(session_->extension().accumulated_frames(), 1u);
}

// The view that it keeps refers to the map's models.
TEST_F(PhotoMode, EndsWithTheMap)
{
    start();
    run("pt_photo");
    session_->draw(3);
    session_->load_map("room");
    session_->view.entity_count = 0;
    session_->draw(3);
    EXPECT_EQ(session_->extension().accumulated_frames(), 1u);
}

} // namespace
} // namespace vkpt::tests
