// SPDX-License-Identifier: GPL-2.0-or-later
// Baked light against the formulas, in rooms of black walls (no bounces) and of grey ones.
#include "tests/map_compiler/map_text.hpp"
#include "tests/map_compiler/texture_folder.hpp"
#include "tools/map_compiler/compiler.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {

using namespace formats;
using namespace tools;

namespace {

const Box room { { -256, -256, 0 }, { 256, 256, 256 } };

Bsp light_room(const std::string& brushes, const std::string& entities, uint8_t wall_index, const Box& air = room)
{
    const TextureFolder folder;
    folder.add({ .name = "wall" }, wall_index);
    folder.add({ .name = "lamp", .flags = SURF_LIGHT, .value = 500 }, 1);
    CompileOptions options;
    options.textures = folder.textures();
    const std::string text = entity_text({ { "classname", "worldspawn" } }, walls_around({ air }, "wall") + brushes)
        + entity_text({ { "classname", "info_player_start" }, { "origin", "100 100 24" } }) + entities;
    return compile_map(text, "light.map", options);
}

struct Luxel {
    glm::vec3 point;
    float r, g, b;
};

// The luxels of style `slot` of the faces on z = `height` that look up. Axis-aligned textures of scale 1 only.
std::vector<Luxel> luxels_on(const Bsp& bsp, float height, size_t slot = 0)
{
    std::vector<Luxel> result;
    for (size_t i = 0; i < bsp.faces.size(); i++) {
        const BspFace& face = bsp.faces[i];
        if (bsp.face_normal(i).z < 0.99f || bsp.face_polygon(i)[0].z != height || face.light_offset < 0
            || face.styles[slot] == 255)
            continue;
        const auto extent = bsp.lightmap_extent(i);
        const BspTexinfo& info = bsp.texinfos[face.texinfo];
        const size_t start = size_t(face.light_offset) + slot * 3 * size_t(extent.size.x * extent.size.y);
        for (int y = 0; y < extent.size.y; y++)
            for (int x = 0; x < extent.size.x; x++) {
                const size_t at = start + 3 * size_t(y * extent.size.x + x);
                const glm::vec2 st = extent.min_st + 16.0f * glm::vec2(x, y) - glm::vec2(info.s_offset, info.t_offset);
                result.push_back({ info.s_axis * st.x + info.t_axis * st.y + glm::vec3(0, 0, height),
                    float(bsp.lighting.at(at)), float(bsp.lighting.at(at + 1)), float(bsp.lighting.at(at + 2)) });
            }
    }
    return result;
}

TEST(Light, PointLightFallsOffLinearly)
{
    const Bsp bsp = light_room("",
        entity_text({ { "classname", "light" }, { "light", "250" }, { "origin", "0 0 128" }, { "_color", "1 0.5 0" } }),
        0);
    int lit = 0;
    for (const Luxel& luxel : luxels_on(bsp, 0)) {
        if (std::max(std::abs(luxel.point.x), std::abs(luxel.point.y)) > 250)
            continue; // luxels on the wall are nudged inwards
        const glm::vec3 way = glm::vec3(0, 0, 128) - (luxel.point + glm::vec3(0, 0, 1));
        const float distance = glm::length(way), expected = std::max(0.0f, (250 - distance) * way.z / distance);
        EXPECT_NEAR(luxel.r, std::max(1.0f, expected), 1.01f);
        EXPECT_NEAR(luxel.g, std::max(1.0f, expected * 0.5f), 1.01f);
        EXPECT_EQ(luxel.b, 1);
        lit += expected > 10;
    }
    EXPECT_GT(lit, 100);
}

// One 64-unit lamp is one patch; far below it, it acts as a point of its area.
TEST(Light, SurfaceLightFallsOffWithTheSquare)
{
    const Bsp bsp = light_room(box_brush({ { 0, 0, 250 }, { 64, 64, 256 } }, "lamp", " 0 1 500"), "", 0);
    const glm::vec3 lamp(32, 32, 249);
    int lit = 0;
    for (const Luxel& luxel : luxels_on(bsp, 0)) {
        if (std::max(std::abs(luxel.point.x), std::abs(luxel.point.y)) > 250)
            continue;
        const glm::vec3 way = lamp - (luxel.point + glm::vec3(0, 0, 1));
        const float squared = glm::dot(way, way), cosine = way.z / std::sqrt(squared);
        const float expected = 0.4f * 500 * 64 * 64 * cosine * cosine / squared;
        // The lamp's 6-unit rim shines too, along the ceiling: nearly nothing on the floor.
        EXPECT_NEAR(luxel.r, expected, 1.5f) << luxel.point.x << " " << luxel.point.y;
        lit++;
    }
    EXPECT_GT(lit, 500);
}

TEST(Light, WallsCastShadows)
{
    const Bsp bsp = light_room(box_brush({ { 64, -256, 0 }, { 80, 256, 200 } }, "wall"),
        entity_text({ { "classname", "light" }, { "light", "400" }, { "origin", "0 0 64" } }), 0);
    for (const Luxel& luxel : luxels_on(bsp, 0)) {
        if (luxel.point.x > 96 && luxel.point.x < 250) {
            EXPECT_EQ(luxel.r, 1) << luxel.point.x;
        }
        if (luxel.point.x > 16 && luxel.point.x < 48 && std::abs(luxel.point.y) < 50) {
            EXPECT_GT(luxel.r, 100);
        }
    }
}

TEST(Light, GreyWallsBounceItIntoTheShadow)
{
    const std::string wall = box_brush({ { 64, -256, 0 }, { 80, 256, 200 } }, "wall");
    const std::string light = entity_text({ { "classname", "light" }, { "light", "400" }, { "origin", "0 0 64" } });
    const Bsp bsp = light_room(wall, light, 2);
    double sum = 0;
    int count = 0;
    for (const Luxel& luxel : luxels_on(bsp, 0))
        if (luxel.point.x > 96 && luxel.point.x < 250) {
            sum += luxel.g;
            count++;
            EXPECT_LE(luxel.r, luxel.g) << "the walls reflect less red";
        }
    EXPECT_GT(sum / count, 3);
    EXPECT_LT(sum / count, 60);
}

// A closed room loses nothing but what its walls take: whatever the form factors are, the mean light over all surfaces
// grows by the geometric series of the reflectivity.
TEST(Light, BouncesConserveEnergy)
{
    const std::string light = entity_text({ { "classname", "light" }, { "light", "230" }, { "origin", "0 0 128" } });
    const auto mean_light = [&](uint8_t index) {
        const Bsp bsp = light_room("", light, index, { { -128, -128, 0 }, { 128, 128, 256 } });
        glm::dvec2 sum(0);
        double weights = 0;
        for (size_t face = 0; face < bsp.faces.size(); face++) {
            const glm::ivec2 size = bsp.lightmap_extent(face).size;
            for (int y = 0; y < size.y; y++)
                for (int x = 0; x < size.x; x++) { // luxels on the rim stand for half as much area
                    const double weight = (x % (size.x - 1) ? 1 : 0.5) * (y % (size.y - 1) ? 1 : 0.5);
                    const size_t at = size_t(bsp.faces[face].light_offset) + 3 * size_t(y * size.x + x);
                    sum += weight * glm::dvec2(bsp.lighting[at], bsp.lighting[at + 1]);
                    weights += weight;
                }
        }
        return sum / weights + 0.5; // bytes are rounded down
    };
    const auto series = [](double reflectivity) {
        double sum = 1, power = 1;
        for (int bounce = 0; bounce < 8; bounce++)
            sum += power *= reflectivity;
        return sum;
    };
    const glm::dvec2 black = mean_light(0), grey = mean_light(2);
    EXPECT_GT(black.x, 10);
    EXPECT_NEAR(grey.x / black.x, series(0.25), 0.04);
    EXPECT_NEAR(grey.y / black.y, series(0.5), 0.08);
}

TEST(Light, StylesGetLightmapsOfTheirOwn)
{
    const Bsp bsp = light_room("",
        entity_text({ { "classname", "light" }, { "light", "300" }, { "origin", "-128 0 100" } })
            + entity_text({ { "classname", "light" }, { "light", "300" }, { "origin", "128 0 100" }, { "style", "5" } })
            + entity_text({ { "classname", "light" }, { "light", "300" }, { "origin", "128 128 100" },
                { "targetname", "switch" } }),
        0);
    const auto sum_near = [](const std::vector<Luxel>& luxels, float x) {
        double sum = 0;
        for (const Luxel& luxel : luxels)
            if (std::abs(luxel.point.x - x) < 20 && std::abs(luxel.point.y) < 20)
                sum += luxel.r;
        return sum;
    };
    EXPECT_GT(sum_near(luxels_on(bsp, 0, 0), -128), 3 * sum_near(luxels_on(bsp, 0, 0), 128));
    EXPECT_GT(sum_near(luxels_on(bsp, 0, 1), 128), 3 * sum_near(luxels_on(bsp, 0, 1), -128));
    bool style_5 = false, style_32 = false;
    for (const BspFace& face : bsp.faces)
        for (const uint8_t style : face.styles) {
            style_5 |= style == 5;
            style_32 |= style == 32;
        }
    EXPECT_TRUE(style_5);
    EXPECT_TRUE(style_32);
    EXPECT_NE(bsp.entity_text.find("\"style\" \"32\""), std::string::npos) << "the game switches that style";
}

TEST(Light, SpotLightsStayInTheirCone)
{
    const Bsp bsp = light_room("",
        entity_text({ { "classname", "light" }, { "light", "300" }, { "origin", "0 0 200" }, { "target", "floor" },
            { "_cone", "20" } })
            + entity_text({ { "classname", "info_notnull" }, { "origin", "0 0 8" }, { "targetname", "floor" } }),
        0);
    for (const Luxel& luxel : luxels_on(bsp, 0)) {
        const float away = std::sqrt(luxel.point.x * luxel.point.x + luxel.point.y * luxel.point.y);
        if (away < 60) {
            EXPECT_GT(luxel.r, 50);
        }
        if (away > 80) {
            EXPECT_EQ(luxel.r, 1);
        }
    }
}

TEST(Light, TheTwoRoomsAreBrighterNearTheirLights)
{
    const Bsp bsp = compile(two_rooms::text());
    float near_lamp = 0, far_from_lamp = 0, near_light = 0, far_from_light = 0;
    const auto note = [](float& brightest, float value) { brightest = std::max(brightest, value); };
    for (const Luxel& luxel : luxels_on(bsp, 0)) {
        if (luxel.point.x > 288 && luxel.point.y < 50) // the floor of B
            note(glm::distance(luxel.point, two_rooms::lamp_in_b) < 220 ? near_lamp : far_from_lamp, luxel.g);
        if (luxel.point.x < 256 && luxel.point.y > 320) // the floor of C
            note(glm::distance(luxel.point, two_rooms::light_in_c) < 200 ? near_light : far_from_light, luxel.r);
    }
    EXPECT_GT(near_lamp, far_from_lamp);
    EXPECT_GT(near_light, far_from_light);
    EXPECT_GT(near_lamp, 10);
    EXPECT_GT(near_light, 10);
}

TEST(Light, SkyAndLiquidsHaveNoLightmap)
{
    const Bsp bsp = compile(two_rooms::text());
    for (const BspFace& face : bsp.faces)
        if (bsp.texinfos[face.texinfo].flags & SURF_WARP) {
            EXPECT_EQ(face.light_offset, -1);
        }
}

} // namespace

} // namespace vkpt::tests
