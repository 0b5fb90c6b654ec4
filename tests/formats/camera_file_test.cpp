// SPDX-License-Identifier: GPL-2.0-or-later
#include "formats/camera_file.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace formats {
namespace {

TEST(CameraFile, HasALineForEachCamera)
{
    const CameraFile file = read_cameras("# cameras\r\n"
                                         "(100, -250.5, 64) (0, 3, 4)   # the door\r\n"
                                         "\n"
                                         "  (1,2,3)(1,0,0) 60\n",
        "c.txt");
    EXPECT_TRUE(file.messages.empty());
    ASSERT_EQ(file.cameras.size(), 2u);
    EXPECT_EQ(file.cameras[0].eye, glm::vec3(100, -250.5f, 64));
    EXPECT_LT(glm::distance(file.cameras[0].forward, glm::vec3(0, 0.6f, 0.8f)), 1e-6f);
    EXPECT_EQ(file.cameras[0].fov_x, 90);
    EXPECT_EQ(file.cameras[1].eye, glm::vec3(1, 2, 3));
    EXPECT_EQ(file.cameras[1].fov_x, 60);
}

TEST(CameraFile, NamesLinesThatItLeavesOut)
{
    const CameraFile file = read_cameras("(1, 2, 3)\n"
                                         "(1, 2) (1, 0, 0)\n"
                                         "(1, 2, 3) (0, 0, 0)\n"
                                         "(1, 2, nan) (1, 0, 0)\n"
                                         "(1e30, 2, 3) (1, 0, 0)\n"
                                         "(1, 2, 3) (1e30, 1e30, 0)\n"
                                         "(1, 2, 3) (1, 0, 0) 179\n"
                                         "(1, 2, 3) (1, 0, 0) wide\n"
                                         "one (1, 2, 3) (1, 0, 0)\n",
        "c.txt");
    EXPECT_TRUE(file.cameras.empty());
    ASSERT_EQ(file.messages.size(), 9u);
    for (size_t i = 0; i < file.messages.size(); i++)
        EXPECT_EQ(file.messages[i].rfind("c.txt, line " + std::to_string(i + 1) + ": ", 0), 0u) << file.messages[i];
    EXPECT_NE(file.messages[2].find("looks nowhere"), std::string::npos);
    EXPECT_NE(file.messages[4].find("outside"), std::string::npos);
    EXPECT_NE(file.messages[6].find("5 to 150"), std::string::npos);
}

TEST(CameraFile, HasLimits)
{
    std::string many;
    for (size_t i = 0; i < max_security_cameras + 3; i++)
        many += "(0, 0, 0) (1, 0, 0)\n";
    const CameraFile file = read_cameras(many, "c.txt");
    EXPECT_EQ(file.cameras.size(), max_security_cameras);
    ASSERT_EQ(file.messages.size(), 1u);
    EXPECT_NE(file.messages[0].find("line 9"), std::string::npos) << file.messages[0];
    EXPECT_THROW(read_cameras(std::string(max_camera_bytes + 1, ' '), "c.txt"), FormatError);
    std::string nonsense;
    for (int i = 0; i < 100; i++)
        nonsense += "?\n";
    EXPECT_EQ(read_cameras(nonsense, "c.txt").messages.size(), CameraFile::max_messages);
}

TEST(CameraFile, WritesWhatItReads)
{
    const SecurityCamera camera { { 0.1f, -20000.25f, 3e-5f }, glm::normalize(glm::vec3(1, 2, -3)), 71.5f };
    const CameraFile file = read_cameras(write_camera(camera), "c.txt");
    ASSERT_EQ(file.cameras.size(), 1u);
    EXPECT_EQ(file.cameras[0].eye, camera.eye);
    EXPECT_LT(glm::distance(file.cameras[0].forward, camera.forward), 1e-6f);
    EXPECT_EQ(file.cameras[0].fov_x, camera.fov_x);
}

} // namespace
} // namespace formats
