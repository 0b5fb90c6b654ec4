// SPDX-License-Identifier: GPL-2.0-or-later
// pt_sky physical: what the formulas say of sky and sun, and what of it arrives in the game.
#include "ref_vkpt/lights/light_aim.hpp"
#include "ref_vkpt/scene/physical_sky.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>
#include <numbers>

namespace vkpt::tests {
namespace {

PhysicalSky sky_at(float elevation, float turbidity = 3)
{
    return PhysicalSky(direction_of_angles(0, elevation), turbidity);
}

// The luminance at the zenith as the paper's formula gives it (A.2), the sun at 45 degrees.
TEST(PhysicalSkyModel, ZenithIsAsBrightAsThePaperSays)
{
    const float pi = std::numbers::pi_v<float>;
    for (const float turbidity : { 2.0f, 3.0f, 6.0f }) {
        const float chi = (4.0f / 9 - turbidity / 120) * (pi / 2);
        const float wanted = (4.0453f * turbidity - 4.9710f) * std::tan(chi) - 0.2155f * turbidity + 2.4192f;
        const float seen = luminance(sky_at(45, turbidity).radiance({ 0, 0, 1 }));
        EXPECT_NEAR(seen, wanted, 0.02f * wanted) << turbidity;
    }
}

TEST(PhysicalSkyModel, LooksLikeDay)
{
    const PhysicalSky noon = sky_at(50), evening = sky_at(3);
    const glm::vec3 zenith = noon.radiance({ 0, 0, 1 });
    EXPECT_GT(zenith.z, 1.5f * zenith.x) << "blue above";
    EXPECT_GT(luminance(noon.radiance(noon.to_sun())), 2 * luminance(zenith)) << "bright around the sun";
    const glm::vec3 away = direction_of_angles(180, 50);
    EXPECT_GT(luminance(noon.radiance({ -1, 0, 0.05f })), 1.2f * luminance(noon.radiance(away)))
        << "and at the horizon";
    const glm::vec3 sun = noon.sun_irradiance(), red = evening.sun_irradiance();
    EXPECT_GT(red.x / red.z, 2 * sun.x / sun.z) << "a low sun is red";
    EXPECT_LT(luminance(red), 0.3f * luminance(sun));
    EXPECT_LT(luminance(sky_at(50, 8).sun_irradiance()), luminance(sun)) << "haze takes of its light";
}

// Of a clear day: 60 to 110 thousand lux of sun, 10 to 20 of sky, which the model is known to see up to twice as
// bright.
TEST(PhysicalSkyModel, IsAsBrightAsTheRealOne)
{
    const PhysicalSky noon = sky_at(50);
    EXPECT_GT(luminance(noon.sun_irradiance()), 60);
    EXPECT_LT(luminance(noon.sun_irradiance()), 110);
    EXPECT_GT(luminance(noon.level_irradiance()), 10);
    EXPECT_LT(luminance(noon.level_irradiance()), 40);
}

// However low a map's sun stands: beside it the sky is as bright as the model has it by day, and never absurd.
TEST(PhysicalSkyModel, LeavesTheProportionsToAMapsSun)
{
    for (const float turbidity : { 3.0f, 6.0f, 10.0f })
        for (const float elevation : { 45.0f, 20.0f, 10.0f, 5.0f, 2.0f, 0.0f }) {
            const PhysicalSky sky = sky_at(elevation, turbidity);
            const float ground = luminance(sky.level_irradiance()) / light_of_map_sun(sky);
            EXPECT_GT(ground, 0.2f) << turbidity << ' ' << elevation;
            EXPECT_LT(ground, 2.001f) << turbidity << ' ' << elevation;
            if (elevation >= 20 && turbidity < 10) {
                EXPECT_EQ(light_of_map_sun(sky), luminance(sky.sun_irradiance())) << turbidity << ' ' << elevation;
            }
        }
}

class PhysicalSkyInMaps : public testing::Test {
protected:
    // Open ground with a roof over the half where x < 0.
    void start(const Pairs& keys, const CvarList& settings)
    {
        folder_.add_wall("wall", white_index);
        Pairs world { { "classname", "worldspawn" } };
        world.insert(world.end(), keys.begin(), keys.end());
        MapBuilder map;
        const uint16_t wall = map.add_material("wall");
        map.add_entity(world);
        map.add_room({ -900, -900, -1 }, { 900, 900, 900 }, map.add_material("sky", formats::SURF_SKY));
        map.add(rectangle({ 0, 0, 0 }, { 800, 0, 0 }, { 0, 800, 0 }), wall);
        map.add_block({ -400, -400, 200 }, { 0, 400, 210 }, wall);
        folder_.add_map("open", map.finish());
        CvarList all { { "pt_bounces", "0" }, { "pt_roughness_default", "1" }, { "pt_sky", "physical" } };
        all.insert(all.end(), settings.begin(), settings.end());
        session_ = nullptr;
        session_ = std::make_unique<Session>(folder_, all);
        session_->load_map("open");
        session_->look({ 0, 0, 100 }, { 1, 0, 100 });
    }
    glm::vec3 light_at(float x)
    {
        const std::vector<IrradianceProbe> probes(64, { { x, 0, 0 }, { 0, 0, 1 } });
        glm::vec3 sum(0);
        for (const glm::vec3& light : session_->probe(probes, 128))
            sum += light / 64.0f;
        return sum;
    }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
};

// In the proportion that the model has; the shadow is blue.
TEST_F(PhysicalSkyInMaps, SunAndSkyLightTheGround)
{
    start({}, { { "pt_sky_elevation", "60" }, { "pt_sky_azimuth", "0" } });
    const PhysicalSky sky(direction_of_angles(0, 60), 3);
    const float edge = -200 / std::tan(glm::radians(60.0f));
    const glm::vec3 lit = light_at(edge + 20), shadowed = light_at(edge - 20), open = light_at(700);
    EXPECT_GT(luminance(lit), 3 * luminance(shadowed));
    EXPECT_GT(shadowed.z / shadowed.x, 1.5f * lit.z / lit.x);
    EXPECT_NEAR(luminance(open), 2, 0.2f);
    session_->set("pt_sun_scale", 0);
    const float of_sky = luminance(light_at(700)) / luminance(open);
    const float level = luminance(sky.level_irradiance());
    EXPECT_NEAR(of_sky, level / (level + luminance(sky.sun_irradiance()) * sky.to_sun().z), 0.05f);
}

TEST_F(PhysicalSkyInMaps, MapsKeepTheirSun)
{
    start({ { "_sun_light", "128" }, { "_sun_angle", "180 -45" } }, {});
    session_->set("pt_sky_scale", 0);
    const glm::vec3 lit = light_at(300);
    EXPECT_NEAR(luminance(lit), std::sqrt(0.5f), 0.03f);
    EXPECT_GT(lit.x, lit.z) << "in the colour that the air gives it";
    EXPECT_EQ(light_at(-220).y, 0);
}

TEST_F(PhysicalSkyInMaps, AMapsLowSunHasASkyThatGoesWithIt)
{
    start({ { "_sun_light", "128" }, { "_sun_angle", "180 -3" } }, { { "pt_sky_turbidity", "6" } });
    session_->set("pt_sun_scale", 0);
    const PhysicalSky sky(direction_of_angles(0, 3), 6);
    const float of_sky = luminance(light_at(700));
    EXPECT_NEAR(of_sky, luminance(sky.level_irradiance()) / light_of_map_sun(sky), 0.1f * of_sky);
}

} // namespace
} // namespace vkpt::tests
