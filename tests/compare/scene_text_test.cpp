// SPDX-License-Identifier: GPL-2.0-or-later
// The files of vkpt export, of a scene of two triangles and a sphere.
#include "client/export/scene_text.hpp"
#include "client/host/file_system.hpp"
#include "formats/image.hpp"
#include "shaders/shared/scene.h"
#include "tests/client/run_program.hpp"

#include <cstring>
#include <gtest/gtest.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

namespace vkpt::tests {
namespace {

using namespace vkpt::client;

class SceneText : public testing::Test {
protected:
    SceneText()
    {
        const float up[3][3] = { { 0, 0, 1 }, { 0, 0, 1 }, { 0, 0, 1 } };
        triangles[0]
            = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0.5f } }, { { 0, 0 }, { 1, 0 }, { 0, 0.25f } }, {}, 1, 0, 1 };
        triangles[1] = { { { 5, 0, 0 }, { 6, 0, 0 }, { 5, 1, 0 } }, {}, {}, 2, -1, 4 };
        for (SceneTriangle& triangle : triangles)
            std::memcpy(triangle.normals, up, sizeof up);
        materials[0] = { "", { 1, 1, 1 }, { 0.5f, 0.25f, 0.125f }, 1, {}, {}, {}, 0.7f, 0, 1, 0 };
        materials[1] = { "textures/lamp.wal", { 1, 0.5f, 1 }, { 1, 1, 1 }, 0.5f, { 4, 6, 8 }, { 2, 3, 4 }, { 0.25f, 0 },
            0.2f, 1, 0.75f, shared::MATERIAL_WARP | shared::MATERIAL_TRANSLUCENT };
        materials[2] = materials[0];
        emitters[0]
            = { shared::EMITTER_TRIANGLE, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0.5f } }, {}, 0, { 2, 3, 4 }, 0.5f, 0 };
        emitters[1] = { shared::EMITTER_SPHERE, {}, { 7, 8, 9 }, 2, { 1, 0, 0 }, 16 * std::numbers::pi_v<float>, 100 };
        contents = { triangles, 2, materials, 3, emitters, 2,
            { { 1, 2, 3 }, { 1, 0, 0 }, { 0, -1, 0 }, { 0, 0, 0.5f } },
            { { "env/rt.pcx", "", "", "", "", "" }, { { 0, 1, 0 }, { -1, 0, 0 }, { 0, 0, 1 } }, { 2, 2, 2 } }, 1.5f };
        // A palette whose entry 5 is red, and pictures of that.
        formats::IndexedImage image { 4, 2, std::vector<uint8_t>(8, 5), {} };
        image.palette[5] = { 255, 0, 0, 255 };
        const auto text_of = [](const std::vector<std::byte>& bytes) {
            return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        };
        folder.write("baseq2/pics/colormap.pcx", text_of(formats::write_pcx(image)));
        folder.write(
            "baseq2/textures/lamp.wal", text_of(formats::write_wal({ 16, 16, std::vector<uint8_t>(256, 5), {} }, {})));
        folder.write("baseq2/env/rt.pcx", text_of(formats::write_pcx(image)));
        files = std::make_unique<FileSystem>(folder.path(), "");
        pictures = std::make_unique<ScenePictures>(*files);
    }
    ScratchFolder folder;
    std::unique_ptr<FileSystem> files;
    std::unique_ptr<ScenePictures> pictures;
    SceneTriangle triangles[2];
    SceneMaterial materials[3];
    SceneEmitter emitters[2];
    SceneContents contents;
};

TEST_F(SceneText, ObjHasTrianglesByMaterial)
{
    const MergedScene merged(contents);
    EXPECT_EQ(make_obj(merged.contents, "a.mtl"),
        "# vkpt export: 2 triangles, Quake units, z up\nmtllib a.mtl\n"
        "v 0 0 0\nv 1 0 0\nv 0 1 0.5\nv 5 0 0\nv 6 0 0\nv 5 1 0\n"
        "vt 0 1\nvt 1 1\nvt 0 0.75\nvt 0 1\nvt 0 1\nvt 0 1\n"
        "vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\n"
        "usemtl material_0\nf 4/4/4 5/5/5 6/6/6\nusemtl material_1\nf 1/1/1 2/2/2 3/3/3\n");
}

TEST_F(SceneText, MtlHasColoursAndRadiance)
{
    const std::string head = "# vkpt export: linear colours, pictures are sRGB; Ke is radiance\n"
                             "newmtl material_0\n# no picture\nKd 0.5 0.25 0.125\nKe 0 0 0\nd 1\nPr 0.7\nPm 0\n"
                             "newmtl material_1\n# textures/lamp.wal\n";
    const MergedScene merged(contents);
    EXPECT_EQ(make_mtl(merged.contents, *pictures), head + "Kd 1 1 1\nKe 2 3 4\nd 0.5\nPr 0.2\nPm 1\n");
    pictures->add(merged.contents);
    const std::string file = "textures/000_textures_lamp.wal.png";
    EXPECT_EQ(make_mtl(merged.contents, *pictures),
        head + "Kd 1 0.5 1\nKe 4 6 8\nd 0.5\nPr 0.2\nPm 1\nmap_Kd " + file + "\nmap_Ke " + file + "\n");
    ASSERT_EQ(pictures->written().size(), 1u);
    EXPECT_EQ(pictures->written()[0].image.at(3, 3), (formats::Rgba8 { 255, 0, 0, 255 }));
    EXPECT_TRUE(pictures->notes().empty());
}

TEST_F(SceneText, SkyShowsItsSides)
{
    const analysis::LinearImage sky = pictures->sky(contents.sky, 64);
    ASSERT_EQ(sky.width, 64);
    ASSERT_EQ(sky.height, 32);
    const auto green_at = [&](int x, int y) { return sky.rgb[3 * (size_t(y) * 64 + size_t(x)) + 1]; };
    EXPECT_EQ(green_at(32, 16), 0); // +x: the red picture
    EXPECT_EQ(green_at(16, 16), 1); // +y: missing, white
    EXPECT_EQ(green_at(0, 16), 1);
    EXPECT_EQ(green_at(32, 1), 1);
    contents.sky.textures[0] = "";
    EXPECT_TRUE(pictures->sky(contents.sky, 64).rgb.empty());
}

TEST_F(SceneText, JsonHasCameraEmittersAndTheirPower)
{
    using std::numbers::pi;
    const nlohmann::json json
        = nlohmann::json::parse(make_scene_json(contents, "maps/a.bsp", 3, { 640, 480 }, "sky.exr"));
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
    EXPECT_EQ(json.at("triangle_emitters"), (std::vector<int> { 0, -1 }));
    EXPECT_EQ(json.at("triangle_ray_masks"), (std::vector<int> { 1, 4 }));
    EXPECT_EQ(json.at("ray_masks").at("alpha_test"), 4);
    EXPECT_EQ(json.at("sky").at("rotation").at(1), (std::vector<int> { -1, 0, 0 }));
    EXPECT_EQ(json.at("sky").at("file"), "sky.exr");
    EXPECT_EQ(json.at("time"), 1.5);
    EXPECT_EQ(json.at("liquids").at("water").at("waves").size(), 3u);
    EXPECT_EQ(json.at("materials").at(1).at("uv_scroll"), (std::vector<double> { 0.25, 0 }));
    EXPECT_EQ(json.at("materials").at(1).at("specular"), 0.75);
    EXPECT_EQ(json.at("materials").at(1).at("flags"), (std::vector<std::string> { "warp", "translucent" }));
}

} // namespace
} // namespace vkpt::tests
