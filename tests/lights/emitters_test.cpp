// SPDX-License-Identifier: GPL-2.0-or-later
#include "map_emitters.hpp"
#include "ref_vkpt/lights/animated_lights.hpp"
#include "ref_vkpt/lights/emitters.hpp"
#include "ref_vkpt/lights/spot_cone.hpp"
#include "synthetic_bsp.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::test {
namespace {

constexpr float pi = 3.14159265358979f;

const FaceTexture reddish = make_texture({ 0.4f, 0.2f, 0.1f });

StaticEmitters extract_with_entities(const std::string& entities, const EmissionScales& scales = {})
{
    formats::Bsp bsp = make_cell_map(2, { true, true, true, true });
    bsp.faces.clear();
    bsp.models[0].face_count = 0;
    bsp.entity_text = entities;
    return extract_emitters(bsp, reddish, scales);
}

bool mentions(const StaticEmitters& emitters, const std::string& text)
{
    return std::any_of(emitters.messages.begin(), emitters.messages.end(),
        [&](const std::string& message) { return message.find(text) != std::string::npos; });
}

TEST(Emitters, FacesBecomeTriangles)
{
    const formats::Bsp bsp = make_cell_map(4, std::vector<bool>(16, true));
    const EmissionScales scales { .face = 0.01f, .sky = 3 };
    const StaticEmitters emitters = extract_emitters(bsp, reddish, scales);
    EXPECT_TRUE(emitters.messages.empty());
    EXPECT_EQ(emitters.emitters.size(), 12u * 2);
    for (size_t face = 0; face < bsp.faces.size(); face++) {
        const int kind = bsp.faces[face].texinfo;
        if (kind == 0) {
            EXPECT_EQ(emitters.first_of_face[face], -1);
            EXPECT_EQ(emitters.count_of_face[face], 0u);
            continue;
        }
        ASSERT_EQ(emitters.count_of_face[face], 2u);
        const auto triangles = triangulate(bsp.face_polygon(face), bsp.face_normal(face));
        for (uint32_t i = 0; i < 2; i++) {
            const shared::Emitter& e = emitters.emitters[size_t(emitters.first_of_face[face]) + i];
            EXPECT_EQ(e.p0, bsp.face_polygon(face)[triangles[i][0]]);
            EXPECT_FLOAT_EQ(e.area, cell_size * cell_size / 2);
            EXPECT_GT(glm::cross(e.p1 - e.p0, e.p2 - e.p0).z, 0);
            EXPECT_EQ(e.type, kind == 3 ? shared::EMITTER_SKY : shared::EMITTER_TRIANGLE);
            const float red = kind == 1 ? 1 : kind == 2 ? 2 : 1.2f;
            EXPECT_FLOAT_EQ(e.radiance.x, red);
            EXPECT_FLOAT_EQ(e.radiance.y, red / 2);
            EXPECT_FLOAT_EQ(e.radiance.z, red / 4);
        }
    }
}

// What a camera ray sees (Material::emission * picture) is, on average, what the sampled emitter sends.
TEST(Emitters, MaterialEmissionAgreesWithRadiance)
{
    const formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    const StaticEmitters emitters = extract_emitters(bsp, reddish);
    ASSERT_EQ(emitters.face_emission.size(), bsp.texinfos.size());
    EXPECT_EQ(emitters.face_emission[0], glm::vec3(0));
    EXPECT_EQ(emitters.face_emission[3], glm::vec3(0)); // sky: not from its own picture
    for (size_t face = 1; face < 3; face++) {
        const shared::Emitter& e = emitters.emitters[size_t(emitters.first_of_face[face])];
        const glm::vec3 shown = emitters.face_emission[bsp.faces[face].texinfo] * reddish.average;
        EXPECT_NEAR(glm::distance(shown, e.radiance), 0, 1e-5);
    }
}

TEST(Emitters, LitSkyEmitsItsValue)
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    bsp.texinfos[3].flags |= formats::SURF_LIGHT;
    bsp.texinfos[3].value = 50;
    const StaticEmitters emitters = extract_emitters(bsp, reddish, { .face = 0.01f, .sky = 7 });
    const shared::Emitter& e = emitters.emitters[size_t(emitters.first_of_face[3])];
    EXPECT_EQ(e.type, shared::EMITTER_SKY);
    EXPECT_FLOAT_EQ(e.radiance.x, 0.5f);
}

TEST(Emitters, SkyEmitsThoughItIsNotDrawn)
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    bsp.texinfos[3].flags |= formats::SURF_NODRAW;
    const StaticEmitters emitters = extract_emitters(bsp, reddish);
    EXPECT_EQ(emitters.count_of_face[3], 2u);
    EXPECT_TRUE(emitters.messages.empty());
}

TEST(Emitters, UndrawnAndBlackLightsAreNamed)
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    bsp.texinfos[1].flags |= formats::SURF_NODRAW;
    MapFaces faces(bsp);
    faces.textures[2].average = glm::vec3(0);
    const StaticEmitters emitters = extract_emitters(faces.source(), faces.triangles);
    EXPECT_EQ(emitters.first_of_face[1], -1);
    EXPECT_EQ(emitters.first_of_face[2], -1);
    EXPECT_TRUE(mentions(emitters, "test/b"));
    EXPECT_TRUE(mentions(emitters, "test/c"));
}

// Rays that bounce pass through what is not whole: its light must not be counted as a wall's.
TEST(Emitters, WhatLetsRaysThroughIsTransparent)
{
    for (const int32_t flag : { formats::SURF_TRANS33, formats::SURF_TRANS66, formats::SURF_ALPHATEST }) {
        formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
        bsp.texinfos[1].flags |= flag;
        const StaticEmitters emitters = extract_emitters(bsp, reddish);
        EXPECT_EQ(emitters.emitters[size_t(emitters.first_of_face[1])].type, shared::EMITTER_TRANSPARENT) << flag;
        EXPECT_EQ(emitters.emitters[size_t(emitters.first_of_face[2])].type, shared::EMITTER_TRIANGLE) << flag;
    }
}

TEST(Emitters, FollowTheOrderOfLeaves)
{
    const formats::Bsp bsp = make_cell_map(16, make_random_cells(16, 0.7, 3));
    const StaticEmitters emitters = extract_emitters(bsp, reddish);
    size_t last = 0;
    for (const shared::Emitter& e : emitters.emitters) {
        const size_t leaf = bsp.find_leaf((e.p0 + e.p1 + e.p2) / 3.0f + glm::vec3(0, 0, 1));
        EXPECT_GE(leaf, last);
        last = leaf;
    }
}

TEST(Emitters, FollowTheFirstLightstyleThatIsNotSteady)
{
    struct Case {
        uint8_t styles[4];
        uint32_t wanted;
    };
    for (const auto& [styles, wanted] : { Case { { 0, 255, 255, 255 }, 0 }, Case { { 0, 40, 33, 255 }, 40 },
             Case { { 7, 0, 255, 255 }, 7 }, Case { { 255, 255, 255, 255 }, 0 }, Case { { 0, 255, 12, 255 }, 12 } }) {
        formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
        for (const size_t face : { 1, 3 })
            std::copy_n(styles, 4, bsp.faces[face].styles);
        const StaticEmitters emitters = extract_emitters(bsp, reddish);
        EXPECT_EQ(emitters.emitters[size_t(emitters.first_of_face[1])].lightstyle, wanted);
        EXPECT_EQ(emitters.emitters[size_t(emitters.first_of_face[2])].lightstyle, 0u);
        EXPECT_EQ(emitters.emitters[size_t(emitters.first_of_face[3])].lightstyle, 0u) << "a sky is not switched";
    }
}

// Three pictures by turns, the second without light: emitters have the brightest one's radiance, a table has the
// shares.
TEST(Emitters, FollowAnAnimation)
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    bsp.texinfos[0].next = 1; // plain, 100, 200
    bsp.texinfos[1].next = 2;
    bsp.texinfos[2].next = 0;
    bsp.faces[2].styles[0] = 9;
    const EmissionScales scales { .face = 0.01f };
    MapFaces faces(bsp, reddish);
    StaticEmitters emitters = extract_emitters(faces.source(scales), faces.triangles);
    AnimatedLights animated(300);
    for (size_t face = 0; face < 3; face++) {
        ASSERT_EQ(emitters.count_of_face[face], 2u);
        const std::span of_face = std::span(emitters.emitters).subspan(size_t(emitters.first_of_face[face]), 2);
        EXPECT_FLOAT_EQ(of_face[0].radiance.x, 2);
        animated.add(faces.source(scales), face, of_face);
        EXPECT_EQ(of_face[0].lightstyle, 300u + uint32_t(face));
        EXPECT_EQ(of_face[1].lightstyle, of_face[0].lightstyle);
    }
    std::vector<float> lightstyles(300, 1.0f);
    lightstyles[9] = 0.5f;
    animated.append_rows(lightstyles, 0.6f); // the second picture of each
    ASSERT_EQ(lightstyles.size(), 303u);
    EXPECT_FLOAT_EQ(lightstyles[300], 0.5f);
    EXPECT_FLOAT_EQ(lightstyles[301], 1);
    EXPECT_FLOAT_EQ(lightstyles[302], 0);
    EXPECT_EQ(animated.at(300).share(0), 0);
    EXPECT_FLOAT_EQ(animated.at(302).share(3), 1);
    EXPECT_FALSE(animated.has(299) || animated.has(303));
}

// A texture with a lamp in its middle on faces without a light value.
FaceTexture make_glowing()
{
    FaceTexture texture = make_texture(glm::vec3(0.1f));
    texture.parts = { { { 0.25f, 0.25f }, { 0.5f, 0.5f }, { 0.8f, 0.4f, 0.2f } } };
    texture.glows = true;
    return texture;
}

TEST(Emitters, GlowWithoutALightValueWherePicturesAreBright)
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    const EmissionScales scales { .glow = 3 };
    const StaticEmitters emitters = extract_emitters(bsp, make_glowing(), scales);
    ASSERT_GE(emitters.first_of_face[0], 0);
    float area = 0;
    for (uint32_t i = 0; i < emitters.count_of_face[0]; i++) {
        const shared::Emitter& e = emitters.emitters[size_t(emitters.first_of_face[0]) + i];
        EXPECT_NEAR(glm::distance(e.radiance, 3.0f * glm::vec3(0.8f, 0.4f, 0.2f)), 0, 1e-5);
        area += e.area;
    }
    EXPECT_NEAR(area, cell_size * cell_size / 16, 1);
    EXPECT_EQ(emitters.face_emission[0], glm::vec3(3));
    // A light entity right before it sends its light.
    const shared::Emitter& lamp = emitters.emitters[size_t(emitters.first_of_face[0])];
    const glm::vec3 before = (lamp.p0 + lamp.p1 + lamp.p2) / 3.0f + glm::vec3(0, 0, 20);
    bsp.entity_text = fmt::format(R"({{ "classname" "light" "origin" "{} {} {}" }})", before.x, before.y, before.z);
    const StaticEmitters with_light = extract_emitters(bsp, make_glowing(), scales);
    EXPECT_EQ(with_light.first_of_face[0], -1);
    EXPECT_EQ(with_light.face_emission[0], glm::vec3(3)); // it is still seen to shine
    bsp.texinfos[0].flags |= formats::SURF_NODRAW;
    EXPECT_EQ(extract_emitters(bsp, make_glowing(), scales).first_of_face[0], -1);
}

// What a material says of the map's own words: bsp_radiance 0, default_radiance, light_styles 0.
TEST(Emitters, GoWithTheirMaterial)
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true)); // plain, 100, 200, a sky
    bsp.faces[1].styles[1] = 40;
    const EmissionScales scales { .face = 0.01f, .sky = 3, .glow = 2 };
    const auto radiance_of = [](const StaticEmitters& emitters, size_t face) {
        return emitters.emitters[size_t(emitters.first_of_face[face])].radiance.x;
    };
    FaceTexture texture = reddish; // brightest: 0.4
    texture.default_radiance = 5;
    const StaticEmitters by_map = extract_emitters(bsp, texture, scales);
    EXPECT_FLOAT_EQ(radiance_of(by_map, 1), 1) << "the map's value goes before it";
    EXPECT_EQ(by_map.emitters[size_t(by_map.first_of_face[1])].lightstyle, 40u);
    texture.takes_light_value = false;
    texture.takes_lightstyles = false;
    const StaticEmitters emitters = extract_emitters(bsp, texture, scales);
    for (const size_t face : { 1, 2 }) {
        EXPECT_FLOAT_EQ(radiance_of(emitters, face), 2 * 5 * 0.4f);
        EXPECT_EQ(emitters.face_emission[bsp.faces[face].texinfo], glm::vec3(2 * 5));
    }
    EXPECT_EQ(emitters.emitters[size_t(emitters.first_of_face[1])].lightstyle, 0u);
    EXPECT_EQ(emitters.first_of_face[0], -1) << "without a light value there is no lamp";
    texture.default_radiance = 0;
    EXPECT_EQ(extract_emitters(bsp, texture, scales).first_of_face[1], -1);
    FaceTexture glowing = make_glowing();
    glowing.default_radiance = 0.5f;
    EXPECT_FLOAT_EQ(radiance_of(extract_emitters(bsp, glowing, scales), 0), 2 * 0.5f * 0.8f);
}

TEST(Emitters, BrushModelsAreSeparate)
{
    formats::Bsp bsp = make_cell_map(2, std::vector<bool>(4, true));
    formats::BspModel door {};
    door.first_face
        = int32_t(add_face(bsp, { { 0, 0, 8 }, { 9, 0, 8 }, { 9, 9, 8 }, { 0, 9, 8 } }, glm::vec3(0, 0, 1), 2));
    door.face_count = 1;
    bsp.models.push_back(door);
    EXPECT_EQ(extract_emitters(bsp, reddish).emitters.size(), 6u);
    const MapFaces faces(bsp, reddish);
    EXPECT_EQ(
        emitters_of_face(faces.source(), size_t(door.first_face), faces.triangles.of(size_t(door.first_face))).size(),
        2u);
}

TEST(PointLights, HaveTheirValueColourAndStyle)
{
    EmissionScales scales;
    scales.point = 0.002f;
    const StaticEmitters emitters = extract_with_entities(
        R"({ "classname" "worldspawn" } { "classname" "light" "origin" "64 64 64" "light" "150" "_color" "1 .5 0" "style" "5" }
           { "classname" "light" "origin" "200 64 64" } { "classname" "lamp" "origin" "64 64 32" })",
        scales);
    ASSERT_EQ(emitters.emitters.size(), 2u);
    const shared::Emitter& first = emitters.emitters[0].lightstyle == 5 ? emitters.emitters[0] : emitters.emitters[1];
    const shared::Emitter& second = emitters.emitters[0].lightstyle == 5 ? emitters.emitters[1] : emitters.emitters[0];
    EXPECT_EQ(first.type, shared::EMITTER_SPHERE);
    EXPECT_EQ(first.p0, glm::vec3(64));
    EXPECT_FLOAT_EQ(first.p1.x, scales.point_light_radius);
    EXPECT_FLOAT_EQ(first.area, 4 * pi * scales.point_light_radius * scales.point_light_radius);
    // Radiant intensity = radiance * cross-section.
    const float cross_section = pi * first.p1.x * first.p1.x;
    EXPECT_FLOAT_EQ(first.radiance.x * cross_section, 150.0f * 150 * 150 * 0.002f);
    EXPECT_FLOAT_EQ(first.radiance.y * cross_section, 0.5f * 150 * 150 * 150 * 0.002f);
    EXPECT_EQ(first.radiance.z, 0);
    EXPECT_FLOAT_EQ(second.radiance.x * cross_section, 300.0f * 300 * 300 * 0.002f); // the default
    EXPECT_EQ(second.lightstyle, 0u);
}

// A light close to the ceiling keeps its power in a smaller sphere that no wall cuts.
TEST(PointLights, StayOutOfWalls)
{
    const StaticEmitters close = extract_with_entities(R"({ "classname" "light" "origin" "64 64 126" "light" "300" })");
    ASSERT_EQ(close.emitters.size(), 1u);
    const shared::Emitter& e = close.emitters[0];
    EXPECT_LE(e.p1.x, 2);
    EXPECT_FLOAT_EQ(e.radiance.x * pi * e.p1.x * e.p1.x, 300.0f * 300 * 300 * EmissionScales().point);

    const StaticEmitters inside = extract_with_entities(R"({ "classname" "light" "origin" "64 64 130" })");
    ASSERT_EQ(inside.emitters.size(), 1u);
    EXPECT_LT(inside.emitters[0].p0.z, cell_size);

    const StaticEmitters buried = extract_with_entities(R"({ "classname" "light" "origin" "64 64 1000" })");
    EXPECT_TRUE(buried.emitters.empty());
    EXPECT_TRUE(mentions(buried, "64 64 1000"));
}

TEST(PointLights, BadEntitiesAreNamedNotFatal)
{
    EXPECT_TRUE(mentions(extract_with_entities(R"({ "classname" "light" "origin" "nowhere" })"), "origin"));
    EXPECT_TRUE(
        mentions(extract_with_entities(R"({ "classname" "light" "origin" "64 64 64" "light" "-200" })"), "-200"));
    const StaticEmitters broken = extract_with_entities(R"({ "classname" "light)");
    EXPECT_TRUE(broken.emitters.empty());
    EXPECT_FALSE(broken.messages.empty());
}

TEST(PointLights, AreAllClassesThatBeginSo)
{
    for (const char* name : { "light", "light_mine1", "light_torch", "lightflare", "light_spot" })
        EXPECT_EQ(extract_with_entities(R"({ "classname" ")" + std::string(name) + R"(" "origin" "64 64 64" })")
                      .emitters.size(),
            1u)
            << name;
    EXPECT_TRUE(extract_with_entities(R"({ "classname" "func_light" "origin" "64 64 64" })").emitters.empty());
}

shared::Emitter extract_spot(const std::string& keys)
{
    const StaticEmitters emitters
        = extract_with_entities(R"({ "classname" "info_null" "targetname" "t1" "origin" "64 64 10" }
        { "classname" "light" "origin" "64 64 64" )"
            + keys + " }");
    return emitters.emitters.size() == 1 ? emitters.emitters[0] : shared::Emitter {};
}

TEST(Spots, AreAimedAsTheCompilersAimThem)
{
    const auto axis_of = [](const std::string& keys) {
        const shared::Emitter e = extract_spot(keys);
        return has_cone(e) ? e.p2 : glm::vec3(0);
    };
    const auto expect_axis = [&](const std::string& keys, glm::vec3 axis) {
        EXPECT_NEAR(glm::distance(axis_of(keys), axis), 0, 1e-5) << keys;
    };
    const float half_root = std::sqrt(0.5f);
    expect_axis(R"("target" "t1")", { 0, 0, -1 });
    expect_axis(R"("_spotangle" "0 -90")", { 0, 0, -1 });
    expect_axis(R"("_mangle" "90 45")", { 0, half_root, half_root });
    expect_axis(R"("_spotvector" "0 -3 0")", { 0, -1, 0 });
    expect_axis(R"("_spotpoint" "64 100 64")", { 0, 1, 0 });
    expect_axis(R"("classname" "light_spot" "angle" "-1")", { 0, 0, 1 });
    expect_axis(R"("classname" "light_spot" "angle" "180")", { -1, 0, 0 });
    // A cone alone aims nothing; nor do targets that are not there, and places that are its own.
    for (const char* keys : { "", R"("_cone" "20")", R"("target" "t2")", R"("_spotvector" "0 0 0")",
             R"("_spotpoint" "64 64 64")", R"("_spotvector" "nan 0 inf")" })
        EXPECT_FALSE(has_cone(extract_spot(keys))) << keys;
}

TEST(Spots, HaveTheirConesInside)
{
    const auto middle_of = [](const shared::Emitter& e) { // degrees
        return 0.5f * (glm::degrees(std::acos(e.p1.z)) + glm::degrees(std::acos(outer_cosine(e))));
    };
    EXPECT_NEAR(middle_of(extract_spot(R"("target" "t1")")), 10, 0.01);
    EXPECT_NEAR(middle_of(extract_spot(R"("target" "t1" "_cone" "35")")), 35, 0.01);
    EXPECT_NEAR(middle_of(extract_spot(R"("target" "t1" "cone" "120")")), 120, 0.01);
    EXPECT_FALSE(has_cone(extract_spot(R"("target" "t1" "_cone" "180")"))); // all round
    // As bright along the axis as the point light.
    EXPECT_EQ(extract_spot(R"("target" "t1")").radiance, extract_spot("").radiance);
}

TEST(DynamicLight, MatchesTheEngineAtHalfItsReach)
{
    const shared::Emitter e = make_dynamic_light(glm::vec3(1, 2, 3), glm::vec3(1, 0.5f, -1), 200);
    EXPECT_EQ(e.reach, 200);
    const float intensity = e.radiance.x * pi * e.p1.x * e.p1.x;
    const float window = 0.9375f * 0.9375f;
    EXPECT_NEAR(intensity * window / (pi * 100 * 100), (200 - 100) / 128.0f, 1e-4);
    EXPECT_FLOAT_EQ(e.radiance.y, 0.5f * e.radiance.x);
    EXPECT_EQ(e.radiance.z, 0);
}

} // namespace
} // namespace vkpt::test
