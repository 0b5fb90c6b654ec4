// SPDX-License-Identifier: GPL-2.0-or-later
// Fog and the sunlight that it scatters, against what the integrals say.
#include "ref_vkpt/scene/fog.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace vkpt::tests {
namespace {

constexpr double pi = std::numbers::pi;

// A wall that shines, far before the eye, in a room of sky.
class Fog : public testing::Test {
protected:
    static constexpr float wall_x = 1000;

    Fog()
    {
        folder_.add_wall("wall", white_index);
        folder_.add_wall("lamp", white_index);
        folder_.add_wall("black", 0);
    }

    void start(const Pairs& fog, const CvarList& settings = {}, bool sun = false)
    {
        MapBuilder map;
        if (sun)
            map.add_entity({ { "classname", "worldspawn" }, { "_sun_light", "128" }, { "_sun_color", "1 1 1" } });
        map.add_room({ -2000, -2000, -2000 }, { 2000, 2000, 2000 }, map.add_material("sky", formats::SURF_SKY));
        map.add(rectangle({ wall_x, 0, 0 }, { 0, -1500, 0 }, { 0, 0, 1500 }),
            sun ? map.add_material("black") : map.add_material("lamp", 0, 1000));
        if (!fog.empty())
            map.add_entity(fog);
        folder_.add_map("fog", map.finish());
        CvarList all { { "pt_bounces", "0" }, { "pt_roughness_default", "1" }, { "pt_sky_scale", "0" },
            { "r_fullbright", "0" }, { "pt_accumulate", "1" } };
        all.insert(all.end(), settings.begin(), settings.end());
        session_ = nullptr;
        session_ = std::make_unique<Session>(folder_, all);
        session_->load_map("fog");
        session_->look({ 0, 0, 0 }, { wall_x, 0, 0 }, 2);
    }

    glm::vec3 seen(int frames = 4) { return session_->accumulate(frames).mean(); }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
};

const Pairs even_box { { "classname", "fog_box" }, { "mins", "200 -500 -500" }, { "maxs", "700 500 500" },
    { "density", "0.002" }, { "_color", "0 0 0" } };

TEST_F(Fog, BoxTakesByItsDepth)
{
    start({});
    const float clear = seen().y;
    ASSERT_GT(clear, 1);
    start(even_box);
    EXPECT_NEAR(seen().y / clear, std::exp(-0.002 * 500), 1e-3);
    // From within.
    session_->look({ 450, 0, 0 }, { wall_x, 0, 0 }, 2);
    EXPECT_NEAR(seen().y / clear, std::exp(-0.002 * 250), 1e-3);
}

// exp(-integral of (a t + b)): the density rises from 0 to 0.004 along the ray.
TEST_F(Fog, DensityMayRise)
{
    start({});
    const float clear = seen().y;
    Pairs box = even_box;
    box[3] = { "density", "0" };
    box.push_back({ "density2", "0.004" });
    box.push_back({ "axis", "x" });
    start(box);
    EXPECT_NEAR(seen().y / clear, std::exp(-0.5 * 0.004 * 500), 2e-3);
    session_->look({ 450, 0, 0 }, { wall_x, 0, 0 }, 2);
    EXPECT_NEAR(seen().y / clear, std::exp(-0.75 * 0.004 * 250), 2e-3);
}

TEST_F(Fog, ShinesInItsColour)
{
    Pairs box = even_box;
    box[4] = { "_color", "0.5 0.25 0" };
    start({});
    const glm::vec3 clear = seen();
    start(box);
    const float left = std::exp(-0.002f * 500);
    const glm::vec3 fog = seen();
    EXPECT_NEAR(fog.x, clear.x * left + 0.5f * (1 - left), 0.01f * fog.x);
    EXPECT_NEAR(fog.y, clear.y * left + 0.25f * (1 - left), 0.01f * fog.y);
    EXPECT_NEAR(fog.z, clear.z * left, 0.01f * fog.z);
}

TEST_F(Fog, IsEverywhereByCvars)
{
    start({});
    const float clear = seen().y;
    session_->set("pt_fog", 0.001);
    session_->set("pt_fog_color", "0 0 0");
    EXPECT_NEAR(seen().y / clear, std::exp(-1.0), 2e-3);
    session_->set("pt_fog_height", 100);
    session_->set("pt_fog_level", -100);
    EXPECT_NEAR(seen().y / clear, std::exp(-std::exp(-1.0)), 2e-3);
    // From 300 units above it, down to the wall's foot: the mean of exp(-z / h) over the way.
    session_->look({ 0, 0, 200 }, { wall_x, 0, -100 }, 1);
    const double length = std::hypot(1000.0, 300.0), mean = (1 - std::exp(-3.0)) / 3;
    EXPECT_NEAR(seen().y / clear, std::exp(-0.001 * length * mean), 4e-3);
    session_->set("pt_fog_color", "blue");
    session_->draw();
    EXPECT_TRUE(session_->has_line("pt_fog_color"));
}

TEST_F(Fog, BoxesThatMakeNoSenseAreNamed)
{
    Pairs box = even_box;
    box[2] = { "maxs", "100 500 500" };
    start(box);
    EXPECT_GT(seen().y, 1) << "left out";
    std::vector<formats::EntityText> entities;
    const Pairs faulty[] = { box, { { "classname", "fog_box" } }, even_box };
    for (const Pairs& pairs : faulty)
        entities.push_back({ { pairs.begin(), pairs.end() } });
    entities[1].pairs = entities[2].pairs;
    entities[1].pairs["density"] = "thick";
    entities.push_back(entities[2]);
    entities[3].pairs["axis"] = "w";
    std::vector<std::string> messages;
    EXPECT_EQ(find_fog_boxes(entities, "maps/a.bsp", messages).size(), 1u);
    ASSERT_EQ(messages.size(), 3u);
    EXPECT_EQ(messages[0].find("maps/a.bsp: fog_box number 1 needs \"mins\""), 0u) << messages[0];
    EXPECT_EQ(messages[1].find("maps/a.bsp: fog_box number 2 needs a \"density\""), 0u) << messages[1];
    EXPECT_EQ(messages[2].find("maps/a.bsp: fog_box number 4 has an \"axis\""), 0u) << messages[2];
    const std::vector<formats::EntityText> many(20, entities[2]);
    EXPECT_EQ(find_fog_boxes(many, "maps/a.bsp", messages).size(), shared::MAX_FOG_BOXES);
    EXPECT_EQ(messages.size(), 3u + 20 - shared::MAX_FOG_BOXES);
}

// The sun stands right above; a slab of fog that it shines through, and whose own depth is small. In-scattered radiance
// of a ray across it: E p(90 degrees) (1 - exp(-s L)).
TEST_F(Fog, ScattersSunlight)
{
    start(even_box, {}, true);
    const double g = 0.75, phase = (1 - g * g) / (4 * pi * std::pow(1 + g * g, 1.5));
    const double wanted = pi * phase * (1 - std::exp(-0.002 * 500));
    EXPECT_NEAR(seen(64).y / wanted, 1, 0.02);
    session_->set("pt_god_rays", 0.5);
    EXPECT_NEAR(seen(64).y / wanted, 0.5, 0.01);
    session_->set("pt_god_rays", 0);
    EXPECT_EQ(seen().y, 0);
}

// A roof over half of the fog takes its sunlight away.
TEST_F(Fog, HasShadowsInIt)
{
    MapBuilder map;
    map.add_entity({ { "classname", "worldspawn" }, { "_sun_light", "128" }, { "_sun_color", "1 1 1" } });
    map.add_room({ -2000, -2000, -2000 }, { 2000, 2000, 2000 }, map.add_material("sky", formats::SURF_SKY));
    map.add(rectangle({ wall_x, 0, 0 }, { 0, -1500, 0 }, { 0, 0, 1500 }), map.add_material("black"));
    map.add_block({ -1000, 0, 300 }, { 1000, 1500, 310 }, map.add_material("black"));
    map.add_entity(even_box);
    folder_.add_map("fog", map.finish());
    session_ = std::make_unique<Session>(
        folder_, CvarList { { "pt_bounces", "0" }, { "pt_sky_scale", "0" }, { "pt_accumulate", "1" } });
    session_->load_map("fog");
    session_->look({ 0, 0, 0 }, { wall_x, 0, 0 }, 40);
    const Radiance picture = session_->accumulate(64);
    // y grows to the left.
    const float shadowed = luminance(picture.mean({ 0, 0 }, { 24, 48 })),
                lit = luminance(picture.mean({ 40, 0 }, { 64, 48 }));
    EXPECT_GT(lit, 0.02f);
    EXPECT_LT(shadowed, 0.02f * lit);
}

// What is seen in a mirror is as far away as the fog behind the mirror, and an eye in water sees no air.
TEST_F(Fog, ScattersLightInTheAirThatIsSeenAlone)
{
    folder_.add_wall("mirror", white_index);
    for (const bool is_mirror : { false, true })
        for (const bool in_water : { false, true }) {
            MapBuilder map;
            map.add_entity({ { "classname", "worldspawn" }, { "_sun_light", "128" }, { "_sun_color", "1 1 1" } });
            map.add_room({ -2000, -2000, -2000 }, { 2000, 2000, 2000 }, map.add_material("sky", formats::SURF_SKY));
            map.add(rectangle({ -wall_x, 0, 0 }, { 0, 1500, 0 }, { 0, 0, 1500 }), map.add_material("black"));
            map.add(rectangle({ is_mirror ? 100 : wall_x, 0, 0 }, { 0, -1500, 0 }, { 0, 0, 1500 }),
                map.add_material(is_mirror ? "mirror" : "black"));
            map.add_entity(even_box);
            folder_.add_map("fog", map.finish());
            session_ = nullptr;
            session_ = std::make_unique<Session>(
                folder_, CvarList { { "pt_bounces", "0" }, { "pt_sky_scale", "0" }, { "pt_accumulate", "1" } });
            session_->load_map("fog");
            session_->look({ 0, 0, 0 }, { wall_x, 0, 0 }, 2);
            session_->view.flags = in_water ? engine::RDF_UNDERWATER : 0;
            const float light = seen(16).y;
            if (is_mirror || in_water)
                EXPECT_LT(light, 1e-4f) << is_mirror << in_water;
            else
                EXPECT_GT(light, 0.02f) << "the way there is free";
        }
}

} // namespace
} // namespace vkpt::tests
