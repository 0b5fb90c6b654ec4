// SPDX-License-Identifier: GPL-2.0-or-later
// Suns from what mappers write, and where they are listed.
#include "map_emitters.hpp"
#include "ref_vkpt/lights/emitters.hpp"
#include "ref_vkpt/lights/light_lists.hpp"
#include "ref_vkpt/lights/suns.hpp"
#include "synthetic_bsp.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <string>

namespace vkpt::test {
namespace {

std::vector<Sun> suns_of(const std::string& text) { return find_suns(formats::parse_entities(text, "test")); }
std::vector<Sun> suns_of_world(const std::string& keys)
{
    return suns_of(R"({ "classname" "worldspawn" )" + keys + " }");
}
void expect_direction(glm::vec3 found, glm::vec3 wanted) { EXPECT_NEAR(glm::distance(found, wanted), 0, 1e-5); }

TEST(Suns, AreOnlyWhereLightIsGiven)
{
    EXPECT_TRUE(suns_of("").empty());
    EXPECT_TRUE(suns_of_world(R"("_sun_angle" "0 -45" "_sun_color" "1 1 1")").empty());
    for (const char* light : { "0", "-5", "nan", "inf", "bright" })
        EXPECT_TRUE(suns_of_world(R"("_sun_light" ")" + std::string(light) + R"(")").empty()) << light;
}

TEST(Suns, HaveWhatTheWorldsKeysSay)
{
    const std::vector<Sun> suns = suns_of_world(R"("_sun_light" "200" "_sun_angle" "90 -30" "_sun_color" "255 128 0"
        "_sun_penumbra" "4" "_sun2_light" "30" "_sun2_vector" "0 0 -2" "_sun2_style" "3")");
    ASSERT_EQ(suns.size(), 2u);
    expect_direction(suns[0].to_sun, { 0, -std::sqrt(0.75f), 0.5f });
    EXPECT_EQ(suns[0].light, 200);
    ASSERT_TRUE(suns[0].colour);
    EXPECT_NEAR(suns[0].colour->y, 128.0f / 255, 1e-5);
    EXPECT_NEAR(suns[0].half_angle, glm::radians(2.0f), 1e-6);
    expect_direction(suns[1].to_sun, { 0, 0, 1 });
    EXPECT_FALSE(suns[1].colour);
    EXPECT_NEAR(suns[1].half_angle, glm::radians(0.5f * sun_diameter), 1e-6);
    EXPECT_EQ(suns[1].lightstyle, 3u);
}

TEST(Suns, AreAimedByLights)
{
    const std::string entities = R"({ "classname" "info_null" "targetname" "star" "origin" "0 0 0" }
        { "classname" "light" "target" "star" "origin" "30 0 40" )";
    const std::vector<Sun> named
        = suns_of(R"({ "classname" "worldspawn" "_sun" "star" "_sun_light" "25" })" + entities + "}");
    ASSERT_EQ(named.size(), 1u);
    expect_direction(named[0].to_sun, { 0.6f, 0, 0.8f });
    const std::vector<Sun> own = suns_of(entities + R"("_sun" "1" "light" "70" "_color" "1 1 0" })");
    ASSERT_EQ(own.size(), 1u);
    expect_direction(own[0].to_sun, { 0.6f, 0, 0.8f });
    EXPECT_EQ(own[0].light, 70);
    EXPECT_EQ(suns_of(entities + R"("_sun" "1" "_light" "80" })").at(0).light, 80);
    EXPECT_EQ(suns_of(entities + R"("_sun" "1" })").at(0).light, 300);
}

TEST(Suns, AreNoLampsAtTheirEntitysPlace)
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    const auto count_lamps = [&](const std::string& key) {
        bsp.entity_text = R"({ "classname" "light" "origin" "0 0 32" "_spotangle" "0 -90" "_sun" ")" + key + R"(" })";
        std::vector<std::string> messages;
        return extract_point_lights(bsp, {}, messages).size();
    };
    EXPECT_EQ(count_lamps("0"), 1u);
    EXPECT_EQ(count_lamps("1"), 0u);
}

// What maps/NAME.lights says comes last.
TEST(Suns, LaterWorldsReplaceKeys)
{
    const std::vector<Sun> suns = suns_of(R"({ "classname" "worldspawn" "_sun_light" "200" "_sun_color" "1 0 0" }
                     { "classname" "worldspawn" "_sun_light" "90" })");
    ASSERT_EQ(suns.size(), 1u);
    EXPECT_EQ(suns[0].light, 90);
    EXPECT_TRUE(suns[0].colour);
}

// A surface that faces it gets `light` lightmap units, however wide the disc is.
TEST(Suns, IrradianceIsTheLightsValue)
{
    for (const float half_angle : { 0.001f, 0.05f, 0.4f }) {
        const shared::Emitter e = make_sun({ .light = 64, .half_angle = half_angle }, glm::vec3(0.2f, 0.4f, 0.1f));
        const float sine = e.p1.x / glm::length(e.p0);
        EXPECT_NEAR(sine, std::sin(half_angle), 1e-6);
        EXPECT_NEAR(e.radiance.y * sine * sine, 0.5f, 1e-4); // irradiance / pi
        EXPECT_NEAR(e.radiance.x / e.radiance.y, 0.5f, 1e-5); // the sky's colour
    }
}

TEST(Suns, AreListedWhereSkyMayBeSeen)
{
    // Two rows of cells with a wall between. Floors 3 and 7 are sky; the second row's goes.
    const int size = 4;
    std::vector<bool> open(16, false);
    for (const int cell : { 0, 1, 2, 3, 8, 9, 10, 11 })
        open[size_t(cell)] = true;
    formats::Bsp half = make_cell_map(size, open);
    half.faces[7].texinfo = 0;
    const StaticEmitters of_half = extract_emitters(half, {});
    LightLists lists;
    lists.build(half, of_half.emitters);
    const shared::Emitter sun = make_sun({ .light = 64, .half_angle = 0.01f }, glm::vec3(1));
    lists.update({ { sun } });
    const auto count_at = [&](glm::vec3 place) {
        return lists.lists()[size_t(half.leaves[half.find_leaf(place)].cluster)].dynamic_count;
    };
    for (int x = 0; x < size; x++) {
        const float at = (float(x) + 0.5f) * cell_size;
        EXPECT_EQ(count_at({ at, 0.5f * cell_size, 64 }), 1u) << x;
        EXPECT_EQ(count_at({ at, 2.5f * cell_size, 64 }), 0u) << x;
    }
    EXPECT_EQ(lists.lists().back().dynamic_count, 1u);
}

} // namespace
} // namespace vkpt::test
