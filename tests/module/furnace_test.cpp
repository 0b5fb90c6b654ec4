// SPDX-License-Identifier: GPL-2.0-or-later
// A closed box whose matte walls emit and reflect: every order of reflection adds the same share of the one before.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr int wall_light_value = 200;
constexpr uint8_t grey = 188; // reflects about half

class Furnace : public testing::Test {
protected:
    // A box of walls with this picture; the greatest component of its radiance is 1 - that of its albedo.
    void start(uint8_t picture)
    {
        picture_ = picture;
        const glm::vec3 albedo = linear_colour(picture);
        const float greatest = std::max({ albedo.x, albedo.y, albedo.z });
        folder_.add_wall("glow", picture);
        MapBuilder furnace, wall;
        furnace.add_room(glm::vec3(-64), glm::vec3(64), furnace.add_material("glow", 0, wall_light_value));
        folder_.add_map("furnace", furnace.finish());
        wall.add(rectangle({ 64, 0, 0 }, { 0, 0, 64 }, { 0, 64, 0 }), wall.add_material("glow", 0, wall_light_value));
        folder_.add_map("wall", wall.finish());
        session_ = std::make_unique<Session>(folder_, CvarList { { "pt_roughness_default", "1" } });
        // One wall alone shows what it emits.
        session_->load_map("wall");
        session_->look({ 0, 0, 0 }, { 64, 0, 0 }, 10);
        session_->draw();
        const glm::vec3 shown = session_->capture().mean();
        const float scale = (1 - greatest) / std::max({ shown.x, shown.y, shown.z });
        emission_ = shown * scale;
        session_->set("pt_emission_scale", scale);
        session_->load_map("furnace");
        session_->look({ 5, -10, 3 }, { 64, 40, 20 });
    }

    // Emission and `reflections` reflections of it; `offset` as in linear_colour.
    glm::vec3 series(int reflections, float offset = 0) const
    {
        const glm::vec3 albedo = linear_colour(picture_, offset);
        glm::vec3 sum(0);
        for (int i = 0; i < 3; i++)
            sum[i] = emission_[i] * (1 - std::pow(albedo[i], float(reflections + 1))) / (1 - albedo[i]);
        return sum;
    }

    // The same radiance everywhere, one that is within half a percent of low .. high.
    void expect_uniform(glm::vec3 low, glm::vec3 high, int frames)
    {
        constexpr float tolerance = 0.005f;
        constexpr int block = 16;
        const Radiance picture = session_->accumulate(frames);
        const glm::vec3 mean = picture.mean();
        for (int channel = 0; channel < 3; channel++) {
            EXPECT_GT(mean[channel], (1 - tolerance) * low[channel]) << "channel " << channel;
            EXPECT_LT(mean[channel], (1 + tolerance) * high[channel]) << "channel " << channel;
        }
        for (int y = 0; y < picture.height; y += block)
            for (int x = 0; x < picture.width; x += block)
                EXPECT_NEAR(picture.mean({ x, y }, { x + block, y + block }).y / mean.y, 1, 2 * tolerance)
                    << "block at " << x << ", " << y;
    }
    void expect_uniform(glm::vec3 expected, int frames) { expect_uniform(expected, expected, frames); }

    GameFolder folder_;
    uint8_t picture_ = 0;
    glm::vec3 emission_ { 0 };
    std::unique_ptr<Session> session_;
};

TEST_F(Furnace, GrowsAsAGeometricSeries)
{
    start(grey);
    for (int bounces = 0; bounces <= 3; bounces++) {
        SCOPED_TRACE(bounces);
        session_->set("pt_bounces", bounces);
        // The picture holds the emission, its direct reflection, and one more reflection a bounce.
        const glm::vec3 expected = series(bounces + 1);
        EXPECT_NEAR(expected.y, 1 - std::pow(linear_colour(grey).y, float(bounces + 2)), 1e-5f);
        expect_uniform(expected, 128);
    }
}

TEST_F(Furnace, ReachesRadianceOne)
{
    start(grey);
    session_->set("pt_bounces", 8);
    expect_uniform(glm::vec3(1), 160);
}

TEST_F(Furnace, KeepsColoursApart)
{
    start(warm_index);
    session_->set("pt_bounces", 2);
    expect_uniform(series(3, -0.5f), series(3, 0.5f), 128);
}

TEST_F(Furnace, EverySamplerAgrees)
{
    start(grey);
    session_->set("pt_bounces", 1);
    for (const std::string& sampler : unbiased_samplers(session_->extension().info())) {
        SCOPED_TRACE(sampler);
        session_->set("pt_light_sampler", sampler);
        expect_uniform(series(2), 256);
    }
}

} // namespace
} // namespace vkpt::tests
