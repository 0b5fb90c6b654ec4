// SPDX-License-Identifier: GPL-2.0-or-later
// Screens that show what security cameras see. A screen fills the view of an eye before it, and the camera sees as much
// as the eye: so the picture has to be the one that is seen from the camera's place.
#include "formats/camera_file.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr float half_width = 64, half_height = 48; // of the screen, and the eye's distance from it
constexpr float screen_x = 100;
const glm::vec3 eye(screen_x - half_width, 0, 0);
const glm::vec3 stage(2000, 0, 0); // what the first camera looks at
const glm::vec3 camera_eye = stage + glm::vec3(-60, -50, 10), camera_target = stage + glm::vec3(20, 30, -5);
const glm::vec3 other_eye = stage + glm::vec3(70, 60, 30);
const CvarList plain { { "pt_bounces", "0" }, { "pt_roughness_default", "1" }, { "pt_light_sampler", "full" } };
const char* const screen_material = "screen:\n    kind CAMERA\n    screen_left 0\n    screen_top 0\n"
                                    "    screen_right 1\n    screen_bottom 0.75\n";

// Differs from left to right, above and below.
void add_stage(MapBuilder& map)
{
    map.add_room(stage + glm::vec3(-100, -100, -60), stage + glm::vec3(100, 100, 80), map.add_material("white"));
    map.add(rectangle(stage + glm::vec3(0, 0, 79), { 0, 16, 0 }, { 16, 0, 0 }), map.add_material("lamp", 0, 1000));
    map.add_block(stage + glm::vec3(-40, 30, -60), stage + glm::vec3(0, 60, 0), map.add_material("red"));
    map.add_block(stage + glm::vec3(30, -20, -60), stage + glm::vec3(60, 20, 30), map.add_material("green"));
    map.add_block(stage + glm::vec3(-10, -10, -60), stage + glm::vec3(10, 10, -40), map.add_material("blue"));
}

// `turned`: the texture lies upside down.
formats::Bsp make_map(bool turned = false, int value = 0)
{
    MapBuilder map;
    add_stage(map);
    const uint16_t screen = map.add_material("screen");
    map.add(rectangle({ screen_x, 0, 0 }, { 0, 0, half_height }, { 0, half_width, 0 }), screen);
    map.add(rectangle({ 0, 0, 60 }, { 0, 16, 0 }, { 16, 0, 0 }), map.add_material("lamp", 0, 300));
    formats::Bsp bsp = map.finish();
    constexpr float texels = 16 / (2 * half_width); // of the texture, which has 16, a unit
    const float sign = turned ? -1 : 1;
    formats::BspTexinfo& info = bsp.texinfos[screen];
    info.value = value;
    info.s_axis = { 0, -sign * texels, 0 };
    info.t_axis = { 0, 0, -sign * texels };
    info.s_offset = half_width * texels;
    info.t_offset = half_height * texels;
    return bsp;
}

class Screens : public testing::Test {
protected:
    Screens()
    {
        for (const auto& [name, index] : { std::pair("white", white_index), { "lamp", white_index },
                 { "red", red_index }, { "green", green_index }, { "blue", blue_index }, { "screen", uint8_t(90) } })
            folder_.add_wall(name, index);
    }
    static std::string camera_line(glm::vec3 from, glm::vec3 at)
    {
        const glm::vec3 way = at - from;
        return fmt::format("({}, {}, {}) ({}, {}, {})\n", from.x, from.y, from.z, way.x, way.y, way.z);
    }
    void start(const formats::Bsp& bsp, const std::string& cameras, const CvarList& cvars = plain)
    {
        folder_.add_map("screens", bsp);
        folder_.add_text("maps/screens.mat", screen_material);
        folder_.add_text("maps/cameras/screens.txt", cameras);
        session_ = nullptr;
        session_ = std::make_unique<Session>(folder_, cvars);
        session_->load_map("screens");
    }
    Radiance see_screen(int frames = 64)
    {
        session_->look(eye, { screen_x, 0, 0 });
        session_->draw();
        return session_->accumulate(frames);
    }
    Radiance see_from(glm::vec3 from, glm::vec3 at, int frames = 64)
    {
        session_->look(from, at);
        session_->draw();
        return session_->accumulate(frames);
    }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
};

// Mean difference of two pictures, of their mean.
double difference(const Radiance& a, const Radiance& b)
{
    double sum = 0, all = 0;
    for (size_t i = 0; i < a.pixels.size(); i++)
        for (int c = 0; c < 3; c++) {
            sum += double(std::abs(a.pixels[i][c] - b.pixels[i][c]));
            all += double(b.pixels[i][c]);
        }
    return sum / all;
}

// The pictures have the same random numbers, so that they differ at edges alone.
constexpr double small_difference = 0.02;

TEST_F(Screens, ShowWhatTheCameraSees)
{
    start(make_map(), "# where the door is\n\n" + camera_line(camera_eye, camera_target));
    const Radiance shown = see_screen(), seen = see_from(camera_eye, camera_target);
    EXPECT_GT(seen.mean().x, 0.01f);
    EXPECT_LT(difference(shown, seen), small_difference);
    Radiance mirrored = seen;
    for (int y = 0; y < seen.height; y++)
        std::reverse(mirrored.pixels.begin() + y * seen.width, mirrored.pixels.begin() + (y + 1) * seen.width);
    EXPECT_GT(difference(shown, mirrored), 5 * small_difference) << "the stage tells left from right";
    session_->set("pt_cameras", 0);
    EXPECT_GT(difference(see_screen(), seen), 5 * small_difference) << "its texture";
}

TEST_F(Screens, TurnWithTheTexture)
{
    start(make_map(true), camera_line(camera_eye, camera_target));
    const Radiance shown = see_screen();
    Radiance turned = see_from(camera_eye, camera_target);
    std::ranges::reverse(turned.pixels);
    EXPECT_LT(difference(shown, turned), 2 * small_difference);
}

// A wider camera, and a rim that is as ever.
TEST_F(Screens, HaveARim)
{
    std::string line = camera_line(camera_eye, camera_target);
    line.pop_back();
    start(make_map(), line + " 120\n");
    Session& session = *session_;
    const Radiance whole = see_screen();
    session.look(camera_eye, camera_target, 120);
    session.draw();
    EXPECT_LT(difference(whole, session.accumulate(64)), small_difference);
    folder_.add_text("maps/screens.mat", std::string(screen_material) + "    screen_left 0.5\n");
    session.load_map("screens");
    const Radiance half = see_screen();
    session.set("pt_cameras", 0);
    const Radiance none = see_screen();
    for (int y = 2; y < 46; y += 4)
        EXPECT_NEAR(half.at(10, y).x, none.at(10, y).x, 0.02f * none.at(10, y).x + 1e-4f) << y;
    EXPECT_GT(difference(half, none), 5 * small_difference);
}

TEST_F(Screens, ChooseTheirCamera)
{
    const std::string cameras = camera_line(camera_eye, camera_target) + camera_line(other_eye, stage);
    start(make_map(), cameras);
    const Radiance first = see_from(camera_eye, camera_target), second = see_from(other_eye, stage);
    ASSERT_GT(difference(first, second), 5 * small_difference);
    // By turns of four seconds.
    std::vector<int> seen;
    for (const float time : { 1.0f, 5.0f, 9.0f }) {
        session_->view.time = time;
        const Radiance shown = see_screen();
        seen.push_back(difference(shown, first) < small_difference ? 1 : 2);
        EXPECT_LT(std::min(difference(shown, first), difference(shown, second)), small_difference) << time;
    }
    EXPECT_NE(seen[0], seen[1]);
    EXPECT_EQ(seen[0], seen[2]);
    // Or always the one that the face's value names.
    for (const int value : { 1, 2 }) {
        start(make_map(false, value), cameras);
        for (const float time : { 1.0f, 5.0f }) {
            session_->view.time = time;
            EXPECT_LT(difference(see_screen(), value == 1 ? first : second), small_difference) << value << ' ' << time;
        }
    }
}

// A camera that sees the screen sees its texture on it: there is an end.
TEST_F(Screens, OnScreensShowTheirTexture)
{
    const glm::vec3 from(20, 30, 20), at(screen_x, 0, 0);
    start(make_map(), camera_line(from, at));
    const Radiance shown = see_screen();
    session_->set("pt_cameras", 0);
    EXPECT_LT(difference(shown, see_from(from, at)), small_difference);
}

// Walls that stand, seen by a camera that stands, while the eye moves: the picture moves with the screen, so filters
// have as much of the past to average as on any wall.
TEST_F(Screens, KeepTheirPastWhileTheEyeMoves)
{
    const CvarList filtered { { "flt_denoiser", "svgf" }, { "flt_taa", "on" }, { "pt_bounces", "1" } };
    double error[2];
    for (const int moves : { 0, 1 }) {
        start(make_map(), camera_line(camera_eye, camera_target), filtered);
        const auto place = [&](int frame) { return eye + glm::vec3(0, moves * (frame - 31) * 1.0f, 0); };
        for (int frame = 0; frame < 32; frame++) {
            session_->view.time = 1 + float(frame) / 60;
            session_->set("pt_seed", frame + 1); // new numbers in each frame, though the same in every run
            session_->look(place(frame), place(frame) + glm::vec3(half_width, 0, 0));
            session_->draw();
        }
        const Radiance picture = session_->capture();
        session_->set("flt_denoiser", "off");
        session_->set("flt_taa", "off");
        error[moves] = difference(picture, see_screen(256));
    }
    // .065 and .081; without a past .092 and .112.
    EXPECT_LT(error[0], 0.075);
    EXPECT_LT(error[1], 0.09);
}

TEST_F(Screens, SayWhatIsWrongWithTheirFile)
{
    start(make_map(), "(1, 2, 3)\n" + camera_line(camera_eye, camera_target) + "(1, 2, 3) (0, 0, 0)\n");
    EXPECT_TRUE(session_->has_line("maps/cameras/screens.txt, line 1: a camera is a line such as"));
    EXPECT_TRUE(session_->has_line("maps/cameras/screens.txt, line 3: the camera looks nowhere"));
    const Radiance shown = see_screen(), seen = see_from(camera_eye, camera_target);
    EXPECT_LT(difference(shown, seen), small_difference);
    // The command's line can be put into the file.
    session_->host().run_text("camera\n");
    EXPECT_TRUE(session_->has_line(fmt::format("({}, {}, {}) (", camera_eye.x, camera_eye.y, camera_eye.z)));
    start(make_map(), std::string(formats::max_camera_bytes + 1, '\n'));
    EXPECT_TRUE(session_->has_line("the map has no cameras now"));
    see_screen(1);
    session_->load_map("screens");
    session_->host().run_text("camera\n");
    EXPECT_TRUE(session_->has_line("camera: start a map")) << "the line is of the map before";
    see_screen(1);
}

} // namespace
} // namespace vkpt::tests
