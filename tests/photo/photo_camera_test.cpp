// SPDX-License-Identifier: GPL-2.0-or-later
// What words and keys make of photo mode's camera.
#include "ref_vkpt/photo/photo_camera.hpp"
#include "shaders/shared/cvars.h"

#include <cmath>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

void expect_near(glm::vec3 value, glm::vec3 expected)
{
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(value[i], expected[i], 1e-3f) << "component " << i;
}

std::string obey(PhotoCamera& camera, std::string_view word, std::vector<std::string_view> numbers)
{
    return obey_words(camera, word, numbers);
}

PhotoInput held(std::initializer_list<PhotoKey> keys)
{
    PhotoInput input;
    for (const PhotoKey key : keys)
        input.held[size_t(key)] = true;
    return input;
}

TEST(PhotoCamera, MovesAlongItsOwnAxes)
{
    PhotoCamera camera;
    EXPECT_EQ(obey(camera, "at", { "10", "20", "30" }), "");
    EXPECT_EQ(obey(camera, "look", { "0", "90" }), ""); // along +y; right is +x
    EXPECT_EQ(obey(camera, "move", { "5", "2", "1" }), "");
    expect_near(camera.eye, { 12, 25, 31 });
    EXPECT_EQ(obey(camera, "turn", { "10", "-180", "3" }), "");
    expect_near(camera.angles, { 10, -90, 3 });
    EXPECT_EQ(obey(camera, "turn", { "100", "0" }), "");
    EXPECT_EQ(camera.angles.x, 90) << "no farther than straight down";
}

TEST(PhotoCamera, ZoomIsOfTheFocalLength)
{
    PhotoCamera camera;
    EXPECT_EQ(obey(camera, "zoom", { "2" }), "");
    EXPECT_NEAR(camera.fov, 2 * 26.565f, 1e-2f); // the tangent of half of 90 degrees, halved
    EXPECT_EQ(obey(camera, "zoom", { "0.5" }), "");
    EXPECT_NEAR(camera.fov, 90, 1e-3f);
    EXPECT_EQ(obey(camera, "fov", { "500" }), "");
    EXPECT_EQ(camera.fov, 160);
    engine::RefDef refdef {};
    set_fov(refdef, 90, 160, 90);
    EXPECT_NEAR(refdef.fov_y, 58.7155f, 1e-3f); // 16 : 9
}

// What a projection can show limits the angle; zoom is of the picture's width on its plane.
TEST(PhotoCamera, AngleOfSightFollowsTheProjection)
{
    PhotoCamera camera = with_projection({}, shared::PROJECTION_FISHEYE);
    EXPECT_EQ(obey(camera, "zoom", { "0.5" }), "");
    EXPECT_NEAR(camera.fov, 180, 1e-3f);
    EXPECT_EQ(obey(camera, "fov", { "500" }), "");
    EXPECT_EQ(camera.fov, 360);
    camera = with_projection(camera, shared::PROJECTION_PANINI);
    EXPECT_EQ(camera.fov, 340);
    camera = with_projection(camera, shared::PROJECTION_PERSPECTIVE);
    EXPECT_EQ(camera.fov, 160);
}

TEST(PhotoCamera, RefusesWhatIsNoNumber)
{
    PhotoCamera camera;
    const PhotoCamera before = camera;
    EXPECT_NE(obey(camera, "at", { "1", "2", "nan" }), "");
    EXPECT_NE(obey(camera, "at", { "1", "2", "inf" }), "");
    EXPECT_NE(obey(camera, "at", { "1", "2" }), "");
    EXPECT_NE(obey(camera, "at", { "1", "2", "3", "4" }), "");
    EXPECT_NE(obey(camera, "exposure", { "1x" }), "");
    EXPECT_NE(obey(camera, "dance", {}), "");
    EXPECT_EQ(camera, before);
}

TEST(PhotoCamera, KeysMoveItByTheTimeThatTheyAreHeld)
{
    PhotoCamera camera;
    EXPECT_FALSE(obey_input(camera, PhotoInput(), 1));
    EXPECT_TRUE(obey_input(camera, held({ PhotoKey::forward }), 0.5f));
    const float way = camera.eye.x;
    EXPECT_GT(way, 10);
    EXPECT_TRUE(obey_input(camera, held({ PhotoKey::back }), 0.25f));
    EXPECT_NEAR(camera.eye.x, way / 2, 1e-3f);
    EXPECT_FALSE(obey_input(camera, held({ PhotoKey::forward, PhotoKey::back }), 1));
    camera.eye = glm::vec3(0);
    EXPECT_TRUE(obey_input(camera, held({ PhotoKey::forward, PhotoKey::fast }), 0.5f));
    EXPECT_NEAR(camera.eye.x, 4 * way, 1e-2f);
    camera.eye = glm::vec3(0);
    EXPECT_TRUE(obey_input(camera, held({ PhotoKey::up, PhotoKey::right }), 0.5f));
    expect_near(camera.eye, { 0, -way / std::sqrt(2.0f), way / std::sqrt(2.0f) });
}

TEST(PhotoCamera, TheMouseTurnsAndItsWheelZooms)
{
    PhotoCamera camera;
    PhotoInput input;
    input.mouse = { 100, 50 };
    EXPECT_TRUE(obey_input(camera, input, 0));
    EXPECT_LT(camera.angles.y, -1) << "to the right";
    EXPECT_GT(camera.angles.x, 0.5f) << "down";
    const float turned = camera.angles.y;
    camera = {};
    camera.fov = 20;
    EXPECT_TRUE(obey_input(camera, input, 0));
    EXPECT_GT(camera.angles.y, turned / 3) << "slower where the lens brings all nearer";
    camera = {};
    input = {};
    input.wheel = 1;
    EXPECT_TRUE(obey_input(camera, input, 0));
    EXPECT_LT(camera.fov, 90);
}

} // namespace
} // namespace vkpt::tests
