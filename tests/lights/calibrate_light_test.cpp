// SPDX-License-Identifier: GPL-2.0-or-later
// The parts of vkpt_calibrate_light that need no renderer.
#include "synthetic_bsp.hpp"
#include "tools/calibrate_light/fit.hpp"
#include "tools/calibrate_light/luxels.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <set>

namespace vkpt::test {
namespace {

using namespace tools;

// A cell map whose face 0 carries lightmaps of lightstyles 3 and 0: value 100 + column there, 10 + column here.
formats::Bsp make_lit_map()
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    formats::BspFace& face = bsp.faces[0];
    const glm::ivec2 size = bsp.lightmap_extent(0).size;
    face.light_offset = 7;
    face.styles[0] = 3;
    face.styles[1] = 0;
    face.styles[2] = face.styles[3] = 255;
    bsp.lighting.assign(7, 0);
    for (const int base : { 100, 10 })
        for (int y = 0; y < size.y; y++)
            for (int x = 0; x < size.x; x++)
                bsp.lighting.insert(bsp.lighting.end(), 3, uint8_t(base + x));
    return bsp;
}

TEST(Luxels, LieOnTheirFaceAtTheirTextureCoordinates)
{
    const formats::Bsp bsp = make_lit_map();
    const std::vector<Luxel> luxels = collect_luxels(bsp);
    const glm::ivec2 size = bsp.lightmap_extent(0).size;
    ASSERT_EQ(size, glm::ivec2(9));
    // The outermost rows lie on the face's edges.
    ASSERT_EQ(luxels.size(), size_t((size.x - 2) * (size.y - 2)));
    std::set<std::pair<float, float>> places;
    const glm::vec3 first = bsp.face_polygon(0)[0];
    for (const Luxel& luxel : luxels) {
        EXPECT_EQ(luxel.face, 0u);
        EXPECT_EQ(luxel.normal, glm::vec3(0, 0, 1));
        EXPECT_NEAR(glm::dot(luxel.position - first, luxel.normal), 0, 1e-3);
        const glm::vec2 st = bsp.texture_coordinates(bsp.texinfos[0], luxel.position);
        const float column = (st.x - bsp.lightmap_extent(0).min_st.x) / 16;
        EXPECT_NEAR(column, std::round(column), 1e-3);
        EXPECT_NEAR(luxel.baked.y * 128, 10 + column, 1e-2); // lightstyle 0, not 3
        places.insert({ std::round(st.x), std::round(st.y) });
    }
    EXPECT_EQ(places.size(), luxels.size());
}

TEST(Luxels, SkewedAxesAndSlopesStillHitThePlane)
{
    formats::Bsp bsp = make_lit_map();
    const glm::vec3 normal = glm::normalize(glm::vec3(1, 2, 2));
    const glm::vec3 corner(60, 100, 100), u = glm::normalize(glm::cross(normal, glm::vec3(0, 0, 1))),
                                          v = glm::cross(normal, u);
    bsp.texinfos[0].s_axis = glm::vec3(0.7f, 0.7f, 0.1f);
    bsp.texinfos[0].t_axis = glm::vec3(0, 0.3f, -1.1f);
    bsp.texinfos[0].s_offset = 33;
    const size_t face
        = add_face(bsp, { corner, corner + 90.0f * u, corner + 90.0f * (u + v), corner + 90.0f * v }, normal, 0);
    const glm::ivec2 size = bsp.lightmap_extent(face).size;
    bsp.faces[face].light_offset = 0;
    bsp.faces[face].styles[0] = 0;
    bsp.faces[face].styles[1] = 255;
    bsp.lighting.assign(size_t(3 * size.x * size.y), 64);
    bsp.models[0].first_face = int32_t(face);
    bsp.models[0].face_count = 1;
    const std::vector<Luxel> luxels = collect_luxels(bsp);
    ASSERT_GT(luxels.size(), 4u);
    for (const Luxel& luxel : luxels) {
        EXPECT_NEAR(glm::dot(luxel.position - corner, normal), 0, 2e-3);
        const glm::vec2 luxel_steps
            = (bsp.texture_coordinates(bsp.texinfos[0], luxel.position) - bsp.lightmap_extent(face).min_st) / 16.0f;
        EXPECT_NEAR(luxel_steps.x, std::round(luxel_steps.x), 1e-3);
        EXPECT_NEAR(luxel_steps.y, std::round(luxel_steps.y), 1e-3);
    }
}

TEST(Luxels, ClippedDarkAndGlowingOnesAreLeftOut)
{
    formats::Bsp clipped = make_lit_map(), dark = make_lit_map(), glowing = make_lit_map();
    std::fill(clipped.lighting.begin(), clipped.lighting.end(), 255);
    std::fill(dark.lighting.begin(), dark.lighting.end(), 2);
    glowing.texinfos[0].flags |= formats::SURF_LIGHT;
    EXPECT_TRUE(collect_luxels(clipped).empty());
    EXPECT_TRUE(collect_luxels(dark).empty());
    EXPECT_TRUE(collect_luxels(glowing).empty());
}

TEST(Luxels, AChoiceHasNoneTwice)
{
    const std::vector<Luxel> all = collect_luxels(make_lit_map());
    const std::vector<Luxel> some = choose_luxels(all, 10, 1);
    ASSERT_EQ(some.size(), 10u);
    std::set<std::pair<float, float>> places;
    for (const Luxel& luxel : some)
        places.insert({ luxel.position.x, luxel.position.y });
    EXPECT_EQ(places.size(), 10u);
    EXPECT_EQ(choose_luxels(all, 1000, 1).size(), all.size());
}

TEST(CalibrationFit, FindsTheFactorsOfMixedMaps)
{
    const Scales truth { 3, 0.5, 1 };
    std::vector<MapComparison> maps(3);
    for (size_t m = 0; m < maps.size(); m++)
        for (int i = 0; i < 400; i++) {
            Comparison luxel;
            luxel.traced = { m == 1 ? 0 : 0.2 + 0.1 * std::sin(i), m == 0 ? 0 : 0.3 + 0.2 * std::cos(2.7 * i), 0 };
            luxel.baked = luxel.traced_with(truth) * std::exp(0.3 * std::sin(11.1 * i));
            maps[m].luxels.push_back(luxel);
        }
    const Scales fitted = fit_factors(maps);
    EXPECT_NEAR(fitted[0], 3, 0.15);
    EXPECT_NEAR(fitted[1], 0.5, 0.025);
    EXPECT_EQ(fitted[2], 1); // no map has any
    for (const MapComparison& map : maps)
        EXPECT_NEAR(measure_ratio(map, fitted).median, 1, 0.05);
}

TEST(CalibrationFit, QuartilesAreInOrder)
{
    MapComparison map;
    for (int i = 0; i <= 100; i++)
        map.luxels.push_back({ { double(i), 0, 0 }, 100 });
    const Quartiles ratio = measure_ratio(map, { 2, 1, 1 });
    EXPECT_DOUBLE_EQ(ratio.lower, 0.5);
    EXPECT_DOUBLE_EQ(ratio.median, 1);
    EXPECT_DOUBLE_EQ(ratio.upper, 1.5);
    EXPECT_EQ(measure_ratio({}, { 1, 1, 1 }).median, 0);
}

TEST(CalibrationVariants, KeepOneKindOfLight)
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    bsp.texinfos[3].flags |= formats::SURF_LIGHT;
    bsp.entity_text = R"({ "classname" "worldspawn" "sky" "unit1_" } { "classname" "light" "origin" "1 2 3" })";
    const formats::Bsp face = keep_lights_of(bsp, LightKind::face), point = keep_lights_of(bsp, LightKind::point),
                       sky = keep_lights_of(bsp, LightKind::sky);
    EXPECT_EQ(face.entity_text.find("\"light\""), std::string::npos);
    EXPECT_NE(face.entity_text.find("unit1_"), std::string::npos);
    EXPECT_TRUE(face.texinfos[1].flags & formats::SURF_LIGHT);
    EXPECT_FALSE(face.texinfos[3].flags & formats::SURF_LIGHT);
    EXPECT_EQ(point.entity_text, bsp.entity_text);
    EXPECT_FALSE(point.texinfos[1].flags & formats::SURF_LIGHT);
    EXPECT_FALSE(sky.texinfos[1].flags & formats::SURF_LIGHT);
    EXPECT_TRUE(sky.texinfos[3].flags & formats::SURF_LIGHT);
}

} // namespace
} // namespace vkpt::test
