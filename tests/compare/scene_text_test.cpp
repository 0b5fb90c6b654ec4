// SPDX-License-Identifier: GPL-2.0-or-later
// The files of vkpt export, of a scene of two triangles and a sphere.
#include "client/export/scene_text.hpp"
#include "shaders/shared/scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <numbers>

namespace vkpt::tests {
namespace {

using namespace vkpt::client;

class SceneText : public testing::Test {
protected:
    SceneText()
    {
        triangles[0] = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0.5f } }, { { 0, 0 }, { 1, 0 }, { 0, 0.25f } }, 1, 0, 1 };
        triangles[1] = { { { 5, 0, 0 }, { 6, 0, 0 }, { 5, 1, 0 } }, {}, 0, -1, 1 };
        materials[0] = { "", { 0.5f, 0.25f, 0.125f }, 1, {}, 0.7f, 0, 0 };
        materials[1] = { "textures/lamp.wal", { 1, 1, 1 }, 0.5f, { 2, 3, 4 }, 0.2f, 1,
            shared::MATERIAL_WARP | shared::MATERIAL_TRANSLUCENT };
        emitters[0]
            = { shared::EMITTER_TRIANGLE, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0.5f } }, {}, 0, { 2, 3, 4 }, 0.5f, 0 };
        emitters[1] = { shared::EMITTER_SPHERE, {}, { 7, 8, 9 }, 2, { 1, 0, 0 }, 16 * std::numbers::pi_v<float>, 100 };
        contents
            = { triangles, 2, materials, 2, emitters, 2, { { 1, 2, 3 }, { 1, 0, 0 }, { 0, -1, 0 }, { 0, 0, 0.5f } } };
    }
    SceneTriangle triangles[2];
    SceneMaterial materials[2];
    SceneEmitter emitters[2];
    SceneContents contents;
};

TEST_F(SceneText, ObjHasTrianglesByMaterial)
{
    EXPECT_EQ(make_obj(contents, "a.mtl"),
        "# vkpt export: 2 triangles, Quake units, z up\nmtllib a.mtl\n"
        "v 0 0 0\nv 1 0 0\nv 0 1 0.5\nv 5 0 0\nv 6 0 0\nv 5 1 0\n"
        "vt 0 1\nvt 1 1\nvt 0 0.75\nvt 0 1\nvt 0 1\nvt 0 1\n"
        "usemtl material_0\nf 4/4 5/5 6/6\nusemtl material_1\nf 1/1 2/2 3/3\n");
}

TEST_F(SceneText, MtlHasColoursAndRadiance)
{
    EXPECT_EQ(make_mtl(contents),
        "# vkpt export: linear colours; Ke is radiance\n"
        "newmtl material_0\n# no picture\nKd 0.5 0.25 0.125\nKe 0 0 0\nd 1\nPr 0.7\nPm 0\n"
        "newmtl material_1\n# textures/lamp.wal\nKd 1 1 1\nKe 2 3 4\nd 0.5\nPr 0.2\nPm 1\n");
}

TEST_F(SceneText, JsonHasCameraEmittersAndTheirPower)
{
    using std::numbers::pi;
    const nlohmann::json json = nlohmann::json::parse(make_scene_json(contents, "maps/a.bsp", 3, { 640, 480 }));
    EXPECT_EQ(json.at("schema"), scene_schema);
    EXPECT_EQ(json.at("frame"), 3);
    EXPECT_NEAR(json.at("camera").at("fov_x").get<double>(), 90, 1e-4);
    EXPECT_NEAR(json.at("camera").at("fov_y").get<double>(), 53.1301, 1e-4);
    EXPECT_EQ(json.at("camera").at("position"), (std::vector<int> { 1, 2, 3 }));
    ASSERT_EQ(json.at("emitters").size(), 2u);
    EXPECT_EQ(json.at("emitter_count"), 2);
    const auto& sphere = json.at("emitters").at(1);
    EXPECT_EQ(sphere.at("type"), "sphere");
    EXPECT_EQ(sphere.at("radius"), 2);
    EXPECT_EQ(sphere.at("reach"), 100);
    EXPECT_NEAR(sphere.at("power").at(0).get<double>(), 16 * pi * pi, 1e-4);
    EXPECT_NEAR(json.at("emitted_power").at(0).get<double>(), pi * 1.0 + 16 * pi * pi, 1e-4);
    EXPECT_NEAR(json.at("emitted_power").at(2).get<double>(), pi * 2.0, 1e-5);
    EXPECT_EQ(json.at("materials").at(1).at("flags"), (std::vector<std::string> { "warp", "translucent" }));
}

} // namespace
} // namespace vkpt::tests
