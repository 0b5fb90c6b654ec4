// SPDX-License-Identifier: GPL-2.0-or-later
// What liquids and glass take from light and from looks that pass them.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr float lamp_height = 200, floor_height = -100;
constexpr uint32_t liquid = formats::SURF_TRANS66 | formats::SURF_WARP;
// Per unit, at pt_water_density 0.5.
const glm::vec3 water_absorption = 0.5f * glm::vec3(0.035f, 0.013f, 0.012f);
const glm::vec3 slime_absorption = 0.5f * glm::vec3(0.200f, 0.010f, 0.050f);

void add_both_sides(MapBuilder& map, const Polygon& polygon, uint16_t material)
{
    map.add(polygon, material);
    map.add({ polygon.rbegin(), polygon.rend() }, material);
}

// A small lamp high above a floor.
MapBuilder make_lamp_map(float floor = floor_height)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, floor }, { 512, 0, 0 }, { 0, 512, 0 }), map.add_material("white"));
    map.add(rectangle({ 0, 0, lamp_height }, { 0, 2, 0 }, { 2, 0, 0 }), map.add_material("lamp", 0, 30000));
    return map;
}

class Media : public testing::Test {
protected:
    Media()
    {
        folder_.add_wall("white", white_index);
        folder_.add_wall("lamp", white_index);
        folder_.add_wall("glass", 0);
        folder_.add_wall("red", red_index);
        folder_.add_wall("green", green_index);
        folder_.add_wall("slime", white_index);
        folder_.add_wall("lava", warm_index);
        folder_.add_wall("sky", white_index);
    }

    void start(const formats::Bsp& bsp)
    {
        folder_.add_map("media", bsp);
        session_ = nullptr;
        session_ = std::make_unique<Session>(folder_,
            CvarList { { "pt_bounces", "0" }, { "pt_roughness_default", "1" }, { "pt_caustics", "0" },
                { "pt_sky_scale", "0" } });
        session_->load_map("media");
        session_->look({ 0, 0, 100 }, { 1, 0, 100 });
    }

    // Irradiance / pi of a point that faces up.
    glm::vec3 light_at(glm::vec3 place)
    {
        constexpr size_t copies = 64;
        const std::vector<IrradianceProbe> probes(copies, { { place.x, place.y, place.z }, { 0, 0, 1 } });
        glm::vec3 sum(0);
        for (const glm::vec3& value : session_->probe(probes, 64))
            sum += value / float(copies);
        return sum;
    }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
};

void expect_share(glm::vec3 share, glm::vec3 wanted, const char* what)
{
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(share[i], wanted[i], 0.01f * wanted[i] + 1e-4f) << what << ", channel " << i;
}

// exp(-s d) of the part of the way that lies in the liquid, straight down and obliquely.
TEST_F(Media, LiquidsTakeFromShadowRays)
{
    const glm::vec3 places[] = { { 0, 0, floor_height }, { 150, 0, floor_height } };
    start(make_lamp_map().finish());
    const glm::vec3 dry[] = { light_at(places[0]), light_at(places[1]) };
    ASSERT_GT(dry[1].x, 0.01f);
    MapBuilder map = make_lamp_map();
    add_both_sides(map, rectangle({ 0, 0, 0 }, { 500, 0, 0 }, { 0, 500, 0 }), map.add_material("white", liquid));
    start(map.finish());
    for (const int i : { 0, 1 }) {
        const float slant = glm::distance(places[i], { 0, 0, lamp_height }) / (lamp_height - floor_height);
        expect_share(light_at(places[i]) / dry[i], glm::exp(water_absorption * (floor_height * slant)), "water");
    }
    session_->set("pt_water_density", 0);
    expect_share(light_at(places[0]) / dry[0], glm::vec3(1), "clear water");
}

// The same with bounce rays: a lamp that shines up at a ceiling which the floor sees through the water.
TEST_F(Media, LiquidsTakeFromBouncedLight)
{
    const auto measure = [&](bool wet) {
        MapBuilder map;
        const uint16_t white = map.add_material("white");
        map.add(rectangle({ 0, 0, floor_height }, { 512, 0, 0 }, { 0, 512, 0 }), white);
        map.add(rectangle({ 0, 0, 60 }, { 0, 8, 0 }, { 8, 0, 0 }), white);
        map.add(rectangle({ 0, 0, 140 }, { 0, 40, 0 }, { 40, 0, 0 }), white);
        map.add(rectangle({ 0, 0, 61 }, { 8, 0, 0 }, { 0, 8, 0 }), map.add_material("lamp", 0, 30000));
        if (wet)
            add_both_sides(
                map, rectangle({ 0, 0, 0 }, { 500, 0, 0 }, { 0, 500, 0 }), map.add_material("white", liquid));
        start(map.finish());
        session_->set("pt_bounces", 1);
        session_->set("pt_accumulate", 1);
        session_->look({ 0, 0, floor_height + 10 }, { 1, 0, floor_height }, 20);
        session_->view.flags = wet ? engine::RDF_UNDERWATER : 0;
        session_->draw(200);
        return session_->capture().mean();
    };
    const glm::vec3 share = measure(true) / measure(false);
    // 100 units of water up to the surface, and 10 to the eye; more for what comes from the ceiling's rim.
    for (int i = 0; i < 3; i++) {
        EXPECT_LT(share[i], std::exp(-110 * water_absorption[i])) << i;
        EXPECT_GT(share[i], std::exp(-125 * water_absorption[i])) << i;
    }
}

// A lamp and a floor in one liquid, without a surface between them: what the leaf is filled with counts.
TEST_F(Media, LeavesAreFilledWithLiquids)
{
    const glm::vec3 place(0, 0, floor_height);
    formats::Bsp bsp = make_lamp_map().finish();
    start(bsp);
    const glm::vec3 dry = light_at(place);
    constexpr float length = lamp_height - floor_height;
    bsp.leaves[0].contents = formats::CONTENTS_WATER;
    start(bsp);
    expect_share(light_at(place) / dry, glm::exp(-length * water_absorption), "water");
    bsp.leaves[0].contents = formats::CONTENTS_SLIME;
    start(bsp);
    expect_share(light_at(place) / dry, glm::exp(-length * slime_absorption), "slime");
}

// What it covers takes its share besides.
TEST_F(Media, SlimeIsGreen)
{
    glm::vec3 light[2];
    for (const int i : { 0, 1 }) {
        MapBuilder map = make_lamp_map(i == 0 ? -10.0f : -50.0f);
        add_both_sides(map, rectangle({ 0, 0, 0 }, { 500, 0, 0 }, { 0, 500, 0 }), map.add_material("slime", liquid));
        start(map.finish());
        const float depth = i == 0 ? 10 : 50;
        light[i] = light_at({ 0, 0, -depth }) * (lamp_height + depth) * (lamp_height + depth);
    }
    expect_share(light[1] / light[0], glm::exp(-40.0f * slime_absorption), "40 units of slime");
}

// Opaque, and bright without a light value, whatever the map says.
TEST_F(Media, LavaGlows)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, -20 }, { 300, 0, 0 }, { 0, 300, 0 }), map.add_material("green", 0, 1000));
    map.add(rectangle({ 0, 0, 0 }, { 300, 0, 0 }, { 0, 300, 0 }), map.add_material("lava", liquid));
    start(map.finish());
    session_->look({ 0, 0, 60 }, { 10, 0, 0 });
    session_->draw();
    const glm::vec3 seen = session_->capture().mean(), colour = linear_colour(warm_index);
    EXPECT_GT(seen.x, 0.3f);
    EXPECT_NEAR(seen.y / seen.x, colour.y / colour.x, 0.02f) << "nothing of what is below";
    const std::vector<IrradianceProbe> probes(64, { { 0, 0, 50 }, { 0, 0, -1 } });
    EXPECT_GT(session_->probe(probes, 16)[0].x, 0.3f) << "it lights what is above";
}

// As much light in all, gathered in lines.
TEST_F(Media, CausticsKeepTheMean)
{
    MapBuilder map;
    map.add_entity({ { "classname", "worldspawn" }, { "_sun_light", "128" }, { "_sun_color", "1 1 1" } });
    map.add_room({ -2000, -2000, -500 }, { 2000, 2000, 500 }, map.add_material("sky", formats::SURF_SKY));
    map.add(rectangle({ 0, 0, -64 }, { 1000, 0, 0 }, { 0, 1000, 0 }), map.add_material("white"));
    add_both_sides(map, rectangle({ 0, 0, 0 }, { 1000, 0, 0 }, { 0, 1000, 0 }), map.add_material("white", liquid));
    start(map.finish());
    std::vector<IrradianceProbe> probes;
    constexpr int across = 64;
    for (int i = 0; i < across * across; i++)
        probes.push_back(
            { { 14.7f * float(i % across - across / 2), 14.3f * float(i / across - across / 2), -64 }, { 0, 0, 1 } });
    const auto measure = [&](float strength) {
        session_->set("pt_caustics", strength);
        double sum = 0, squares = 0;
        for (const glm::vec3& light : session_->probe(probes, 8)) {
            sum += double(light.y);
            squares += double(light.y) * double(light.y);
        }
        const double mean = sum / across / across;
        return std::pair(mean, std::sqrt(std::max(squares / across / across - mean * mean, 0.0)) / mean);
    };
    const auto [even, even_spread] = measure(0);
    const auto [lines, lines_spread] = measure(1);
    const auto [half, half_spread] = measure(0.5f);
    // Of a sun of 128 straight above, after 64 units of water: pi / 128 * light, times what the water leaves.
    const double arrives = std::exp(-64.0 * double(water_absorption.y));
    EXPECT_NEAR(even / arrives, 1, 0.02);
    EXPECT_NEAR(lines / arrives, 1, 0.02);
    EXPECT_NEAR(half / arrives, 1, 0.02);
    EXPECT_LT(even_spread, 0.02);
    EXPECT_GT(lines_spread, 0.3);
    EXPECT_NEAR(half_spread / lines_spread, 0.5, 0.05);
}

// Liquids that stand, as waterfalls do, have waves as those that lie.
TEST_F(Media, StandingLiquidsHaveWaves)
{
    MapBuilder map;
    add_both_sides(map, rectangle({ 0, 0, 0 }, { 0, 200, 0 }, { 0, 0, 200 }), map.add_material("white", liquid));
    for (int i = -8; i < 8; i++)
        map.add(rectangle({ -150, 20.0f * float(i), 0 }, { 0, 10, 0 }, { 0, 0, 300 }),
            map.add_material(i % 2 == 0 ? "red" : "green"));
    start(map.finish());
    session_->set("r_fullbright", 1);
    session_->look({ 150, 0, 0 }, { 0, 0, 0 }, 60);
    session_->view.time = 0;
    session_->draw();
    const Radiance before = session_->capture();
    session_->draw();
    EXPECT_EQ(error_between(session_->capture(), before), 0);
    session_->view.time = 1;
    session_->draw();
    EXPECT_GT(error_between(session_->capture(), before), 1e-4);
}

// In the dark: lava glows, water does not.
TEST_F(Media, KindsOfMaterialsSayWhichLiquidItIs)
{
    MapBuilder map;
    add_both_sides(map, rectangle({ 0, 0, 0 }, { 200, 0, 0 }, { 0, 200, 0 }), map.add_material("green", liquid));
    const formats::Bsp bsp = map.finish();
    const auto see = [&] {
        start(bsp);
        session_->look({ 0, 0, 100 }, { 1, 0, 0 }, 60);
        session_->draw();
        return double(session_->capture().mean().y);
    };
    EXPECT_LT(see(), 1e-3);
    folder_.add_text("maps/media.mat", "green:\n    kind lava\n");
    EXPECT_GT(see(), 0.05);
}

// 1 - a + a * albedo of what is behind a pane of opacity a.
TEST_F(Media, GlassColoursTheLightThatPasses)
{
    const glm::vec3 place(0, 0, floor_height);
    start(make_lamp_map().finish());
    const glm::vec3 bare = light_at(place);
    for (const auto& [flags, opacity] :
        { std::pair { formats::SURF_TRANS33, 0.33f }, std::pair { formats::SURF_TRANS66, 0.66f } }) {
        MapBuilder map = make_lamp_map();
        map.add_block({ -80, -80, 40 }, { 80, 80, 44 }, map.add_material("red", flags));
        start(map.finish());
        expect_share(
            light_at(place) / bare, glm::vec3(1 - opacity) + opacity * linear_colour(red_index), "behind red glass");
        expect_share(light_at({ 400, 0, floor_height }) / light_at({ -400, 0, floor_height }), glm::vec3(1), "beside");
    }
}

// A pane of the map above one that moves, which are in trees of their own; then each alone.
TEST_F(Media, MovingGlassColoursTheLightThatPasses)
{
    constexpr float opacity = 0.66f;
    const glm::vec3 place(0, 0, floor_height);
    const auto behind = [](int colour) { return glm::vec3(1 - opacity) + opacity * linear_colour(colour); };
    start(make_lamp_map().finish());
    const glm::vec3 bare = light_at(place);
    for (const bool has_fixed : { true, false }) {
        MapBuilder map = make_lamp_map();
        if (has_fixed)
            map.add_block({ -80, -80, 80 }, { 80, 80, 84 }, map.add_material("green", formats::SURF_TRANS66));
        map.begin_brush_model();
        map.add_block({ -80, -80, -2 }, { 80, 80, 2 }, map.add_material("red", formats::SURF_TRANS66));
        start(map.finish());
        const glm::vec3 fixed = has_fixed ? behind(green_index) : glm::vec3(1);
        const engine::Entity pane = make_entity(session_->module().register_model("*1"), { 0, 0, 40 });
        session_->view.entities = &pane;
        for (const int count : { 0, 1 }) {
            session_->view.entity_count = count;
            session_->draw();
            expect_share(light_at(place) / bare, count == 1 ? fixed * behind(red_index) : fixed, "behind panes");
        }
        session_->view.entities = nullptr;
        session_->view.entity_count = 0;
    }
}

// Of a thin pane of index 1.5: 2 r / (1 + r), r being Fresnel's reflectance of one of its sides.
TEST_F(Media, GlassReflects)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 0, 200, 0 }, { 0, 0, 200 }), map.add_material("glass", formats::SURF_TRANS33));
    map.add(rectangle({ 400, 0, 0 }, { 0, -2000, 0 }, { 0, 0, 2000 }), map.add_material("white"));
    start(map.finish());
    session_->set("r_fullbright", 1);
    for (const float degrees : { 0.0f, 45.0f, 70.0f }) {
        const float angle = degrees * float(M_PI) / 180, cosine = std::cos(angle);
        session_->look({ 60 * cosine, 60 * std::sin(angle), 0 }, { 0, 0, 0 }, 1);
        const float sine_behind = std::sin(angle) / 1.5f, cosine_behind = std::sqrt(1 - sine_behind * sine_behind);
        const float across = (cosine - 1.5f * cosine_behind) / (cosine + 1.5f * cosine_behind);
        const float along = (1.5f * cosine - cosine_behind) / (1.5f * cosine + cosine_behind);
        const float once = 0.5f * (across * across + along * along), wanted = 2 * once / (1 + once);
        EXPECT_NEAR(session_->accumulate(256).mean().y, wanted, 0.03f * wanted) << degrees;
    }
}

// What is behind a pane, rough as this one is, is seen in its colour, besides what the pane shows.
TEST_F(Media, GlassColoursWhatIsBehind)
{
    MapBuilder map;
    map.add(rectangle({ 0, 0, 0 }, { 0, 200, 0 }, { 0, 0, 200 }), map.add_material("red", formats::SURF_TRANS33));
    map.add(rectangle({ -100, 0, 0 }, { 0, 2000, 0 }, { 0, 0, 2000 }), map.add_material("white"));
    start(map.finish());
    session_->set("r_fullbright", 1);
    session_->look({ 60, 0, 0 }, { 0, 0, 0 }, 1);
    const float opacity = 0.33f;
    const glm::vec3 red = linear_colour(red_index), seen = session_->accumulate(512).mean();
    const glm::vec3 wanted = opacity * red + (1 - opacity) * (glm::vec3(1 - opacity) + opacity * red);
    for (int i = 0; i < 3; i++)
        EXPECT_NEAR(seen[i], wanted[i], 0.03f) << i;
}

} // namespace
} // namespace vkpt::tests
