// SPDX-License-Identifier: GPL-2.0-or-later
// Suns and spots on a floor under an open sky: how bright, where shadows begin and end.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <numbers>

namespace vkpt::tests {
namespace {

constexpr double pi = std::numbers::pi;
const CvarList matte_sunlit { { "pt_bounces", "0" }, { "pt_roughness_default", "1" }, { "pt_sky_scale", "0" } };

class Suns : public testing::Test {
protected:
    static constexpr float roof_height = 200;

    // A roof over the half where x < 0, and beyond the sky another room's floor, through which nothing may be seen.
    Suns()
    {
        folder_.add_wall("wall", white_index);
        const uint16_t wall = map_.add_material("wall");
        map_.add_room({ -512, -512, -1 }, { 512, 512, 511 }, map_.add_material("sky", formats::SURF_SKY));
        map_.add(rectangle({ 0, 0, 0 }, { 500, 0, 0 }, { 0, 500, 0 }), wall);
        map_.add(rectangle({ -250, 0, roof_height }, { 250, 0, 0 }, { 0, 500, 0 }), wall);
        map_.add(rectangle({ 0, 0, 900 }, { 3000, 0, 0 }, { 0, 3000, 0 }), wall);
    }

    void add_map(const Pairs& keys)
    {
        Pairs world { { "classname", "worldspawn" } };
        world.insert(world.end(), keys.begin(), keys.end());
        map_.add_entity(world);
        folder_.add_map("suns", map_.finish());
    }

    // Irradiance / pi on the floor at (x, 0).
    static glm::dvec3 measure(Session& session, float x)
    {
        constexpr size_t copies = 64;
        const std::vector<IrradianceProbe> probes(copies, { { x, 0, 0 }, { 0, 0, 1 } });
        glm::dvec3 sum(0);
        for (const glm::vec3& light : session.probe(probes, 256))
            sum += glm::dvec3(light) / double(copies);
        return sum;
    }

    MapBuilder map_;
    GameFolder folder_;
};

// How much of a disc is left of a straight edge that runs at `u` radii from its centre.
double share_of_disc(double u)
{
    const double inside = std::clamp(u, -1.0, 1.0);
    return 0.5 + (inside * std::sqrt(1 - inside * inside) + std::asin(inside)) / pi;
}

// Right above, ten degrees across: the edge's shadow fades over 2 * 200 * tan(5 degrees) = 35 units.
TEST_F(Suns, PenumbraIsAsWideAsTheDisc)
{
    add_map({ { "_sun_light", "128" }, { "_sun_color", "1 1 1" }, { "_sun_penumbra", "10" } });
    Session session(folder_, matte_sunlit);
    session.load_map("suns");
    const double radius = double(roof_height) * std::tan(glm::radians(5.0));
    for (const double u : { -1.2, -0.7, -0.3, 0.0, 0.3, 0.7, 1.2 })
        EXPECT_NEAR(measure(session, float(u * radius)).y, share_of_disc(u), 0.01) << u;
    session.set("pt_sun_scale", 0.5);
    EXPECT_NEAR(measure(session, 100).y, 0.5, 0.005);
}

TEST_F(Suns, ShineObliquely)
{
    add_map({ { "_sun_light", "256" }, { "_sun_color", "1 .5 0" }, { "_sun_angle", "0 -60" } });
    Session session(folder_, matte_sunlit);
    session.load_map("suns");
    const float edge = roof_height / std::tan(glm::radians(60.0f));
    const glm::dvec3 lit = measure(session, edge + 5), shadowed = measure(session, edge - 5);
    EXPECT_NEAR(lit.x, 2 * std::sin(glm::radians(60.0)), 0.02);
    EXPECT_NEAR(lit.y, 0.5 * lit.x, 0.01);
    EXPECT_EQ(lit.z, 0);
    EXPECT_EQ(shadowed.x, 0);
}

// Every sampler has it in its list, and weighs it right.
TEST_F(Suns, AreFoundByEverySampler)
{
    add_map({ { "_sun_light", "128" }, { "_sun_color", "1 1 1" }, { "_sun_penumbra", "10" } });
    Session session(folder_, matte_sunlit);
    session.load_map("suns");
    for (const char* const* name = session.extension().info().light_samplers; *name; name++) {
        session.set("pt_light_sampler", *name);
        for (const char* weight : { "brdf_centre", "ltc" }) {
            session.set("pt_light_weight", weight);
            EXPECT_NEAR(measure(session, 0).y, 0.5, 0.02) << *name << ' ' << weight;
        }
    }
}

// maps/NAME.lights is read as if it stood in the map.
TEST_F(Suns, AreAddedByFiles)
{
    add_map({ { "_sun_light", "128" }, { "_sun_color", "1 1 1" } });
    folder_.add_text("maps/suns.lights", R"({ "classname" "worldspawn" "_sun_light" "64" })");
    {
        Session session(folder_, matte_sunlit);
        session.load_map("suns");
        EXPECT_NEAR(measure(session, 100).y, 0.5, 0.005);
    }
    folder_.add_text("maps/suns.lights", R"({ "classname" "worldspawn" "_sun_light" "64)");
    Session session(folder_, matte_sunlit);
    session.load_map("suns");
    EXPECT_TRUE(session.has_line("maps/suns.lights"));
    EXPECT_NEAR(measure(session, 100).y, 1, 0.01);
}

// A white spot on a dark sky, right above and a little to the side where x grows: with all of the sky's light in it,
// level ground that sees it gets what it got from all of the sky, and what does not see it nothing.
TEST_F(Suns, ArePaintedOnSkies)
{
    for (const char* side : { "rt", "bk", "lf", "ft", "up", "dn" }) {
        formats::Image image { 64, 64, std::vector<formats::Rgba8>(64 * 64, { 60, 60, 60, 255 }) };
        if (std::string_view(side) == "up")
            for (size_t y = 46; y < 50; y++) // to the right of this side's picture is -y, downwards +x
                std::fill_n(image.pixels.begin() + long(y * 64 + 30), 4, formats::Rgba8 { 255, 255, 255, 255 });
        folder_.add(std::string("env/sunny") + side + ".tga", formats::write_tga(image));
    }
    add_map({});
    Session session(folder_, { { "pt_bounces", "0" }, { "pt_roughness_default", "1" }, { "pt_sky_sun", "1" } });
    session.load_map("suns", "sunny");
    // At x = +.5 of the side: 26.6 degrees off the zenith, so that shadows fall 100 units towards -x.
    const double lit = measure(session, -90).y, shadowed = measure(session, -110).y;
    EXPECT_EQ(shadowed, 0);
    session.set("pt_sky_sun", 0);
    session.load_map("suns", "sunny");
    // Of all of the sky the roof takes a little at this distance.
    EXPECT_NEAR(measure(session, 400).y / lit, 0.95, 0.07);
}

// A spot under the roof's height lights its circle alone.
TEST_F(Suns, SpotsHaveTheirCircle)
{
    map_.add_entity({ { "classname", "light" }, { "origin", "200 0 100" }, { "light", "300" }, { "_cone", "30" },
        { "_spotangle", "0 -90" } });
    map_.add_entity({ { "classname", "light" }, { "origin", "-300 0 100" }, { "light", "300" } });
    add_map({});
    Session session(folder_, matte_sunlit);
    session.set("pt_light_sampler", "full");
    session.load_map("suns");
    const float edge = 100 * std::tan(glm::radians(30.0f));
    const double middle = measure(session, 200).y, ball = measure(session, -300).y;
    EXPECT_NEAR(middle / ball, 1, 0.01);
    EXPECT_NEAR(measure(session, 200 + 0.85f * edge).y / measure(session, -300 + 0.85f * edge).y, 1, 0.02);
    // Of the other one, which shines all round, there is some light here.
    EXPECT_LT(measure(session, 200 + 1.2f * edge).y, 0.02 * middle);
    EXPECT_NEAR(measure(session, 200 + edge).y / measure(session, -300 + edge).y, 0.5, 0.1);
}

} // namespace
} // namespace vkpt::tests
