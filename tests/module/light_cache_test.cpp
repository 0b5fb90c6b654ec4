// SPDX-License-Identifier: GPL-2.0-or-later
// The light cache at the ends of bounce rays: the picture's light stays, follows lightstyles at once, passes no wall,
// and has less noise.
#include "tests/module/average_frames.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>

namespace vkpt::tests {
namespace {

constexpr int blinking_style = 5;
constexpr glm::ivec2 room_picture_size { 64, 48 };

// What is seen is lit by bounces alone, above all from the spot on a wall right beside a lamp behind a screen.
class LightCache : public testing::Test {
protected:
    LightCache()
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("metal", 180);
    }

    // The lamp's distance from the wall says how much brighter the spot is than what it lights.
    void add_room(int style, const char* material = "wall", float lamp_distance = 8)
    {
        MapBuilder map;
        const uint16_t wall = map.add_material(material);
        map.add_room({ -256, -256, 0 }, { 256, 256, 192 }, wall);
        map.add_block({ -200, -100, 0 }, { -192, 100, 160 }, wall);
        map.add_point_light({ -256 + lamp_distance, 0, 80 }, 200, style);
        folder_.add_map("room", map.finish());
    }

    // Of metal: two lamps behind the screen light the wall between them from both sides.
    void add_room_of_two_lamps()
    {
        MapBuilder map;
        const uint16_t metal = map.add_material("metal");
        map.add_room({ -256, -256, 0 }, { 256, 256, 192 }, metal);
        map.add_block({ -200, -100, 0 }, { -192, 100, 160 }, metal);
        for (float y : { -80.f, 80.f })
            map.add_point_light({ -228, y, 80 }, 200, 0);
        folder_.add_map("room", map.finish());
    }

    std::unique_ptr<Session> start(const CvarList& cvars, const char* map = "room")
    {
        auto session = std::make_unique<Session>(folder_, cvars, room_picture_size);
        session->set("pt_indirect", "cache");
        session->load_map(map);
        session->look({ 240, -200, 120 }, { -180, 60, 40 });
        return session;
    }

    GameFolder folder_;
};

// Of frames without history, so that no filter and no limit touches their light; anti-aliasing moves the camera within
// the pixel, as in converged pictures.
Radiance mean_of_first_frames(Session& session, int frames)
{
    session.draw(2); // the cache gets its first values after a view
    return average_frames(session, frames, [&session] { session.view.time += 100; });
}

// |ratio - 1| of the means of blocks of pixels, ascending.
std::vector<float> block_errors(const Radiance& picture, const Radiance& expected, glm::ivec2 block)
{
    std::vector<float> errors;
    for (int y = 0; y < picture.height; y += block.y)
        for (int x = 0; x < picture.width; x += block.x) {
            const glm::ivec2 first { x, y }, end = first + block;
            errors.push_back(std::abs(luminance(picture.mean(first, end)) / luminance(expected.mean(first, end)) - 1));
        }
    std::ranges::sort(errors);
    return errors;
}

// Against the converged picture that is aimed by the cache and does not read it; that one is compared with one without
// the cache in LetsPhotoModeConvergeToTheSame.
// A quarter's mean is known to 1 % from 1,600 frames of walls, and from 3,200 of metal.
void expect_same_light(Session& session, int frames, std::optional<float> max_error_of_sixteenths = {})
{
    const Radiance expected = session.accumulate(2048);
    session.set("pt_accumulate", "0");
    const Radiance cached = mean_of_first_frames(session, frames);
    ASSERT_GT(luminance(expected.mean()), 0);
    EXPECT_NEAR(luminance(cached.mean()) / luminance(expected.mean()), 1, 0.02);
    const std::vector<float> errors = block_errors(cached, expected, room_picture_size / 2);
    EXPECT_LT(errors.back(), 0.05);
    if (max_error_of_sixteenths) {
        EXPECT_LT(block_errors(cached, expected, room_picture_size / 4).back(), *max_error_of_sixteenths);
    }
}

const CvarList unlimited { { "flt_denoiser", "temporal" }, { "flt_taa", "on" }, { "pt_seed", "0" } };

TEST_F(LightCache, KeepsTheLight)
{
    add_room(0);
    expect_same_light(*start(unlimited), 1600);
}

// The layer is all that is seen of it: the directions that light comes from matter.
TEST_F(LightCache, KeepsTheLightOfMetal)
{
    add_room(0, "metal", 28); // nearer, neither picture is known well enough
    expect_same_light(*start(unlimited), 3200);
}

// The cache knows the lamps apart: taken for one, they would leave a sixteenth of the picture 21 % too dark.
TEST_F(LightCache, KeepsTheLightOfMetalFromSeveralSides)
{
    add_room_of_two_lamps();
    expect_same_light(*start(unlimited), 3200, 0.12f);
}

// Errors of frames without history, with the cache over without.
double error_ratio(Session& session)
{
    const Radiance expected = session.accumulate(4096);
    session.set("pt_accumulate", "0");
    const auto error = [&](const char* which) {
        session.set("pt_indirect", which);
        session.draw(2);
        double sum = 0;
        for (int i = 0; i < 128; i++) {
            session.view.time += 100;
            session.draw();
            sum += error_between(session.capture(), expected);
        }
        return sum;
    };
    const double traced = error("trace");
    return error("cache") / traced;
}

TEST_F(LightCache, HasLessNoise)
{
    add_room(0);
    EXPECT_LT(error_ratio(*start({ { "flt_denoiser", "temporal" }, { "pt_seed", "0" } })), 0.3);
}

TEST_F(LightCache, HasLessNoiseOnMetalLitFromSeveralSides)
{
    add_room_of_two_lamps();
    EXPECT_LT(error_ratio(*start({ { "flt_denoiser", "temporal" }, { "pt_seed", "0" } })), 0.8);
}

TEST_F(LightCache, FollowsLightstylesAtOnce)
{
    add_room(blinking_style);
    const auto session = start({ { "flt_denoiser", "temporal" }, { "pt_seed", "0" } });
    const auto mean_after_a_cut = [&](float scale) {
        session->light_style(blinking_style, scale);
        double sum = 0;
        for (int i = 0; i < 32; i++) {
            session->view.time += 100;
            session->draw();
            sum += luminance(session->capture().mean());
        }
        return sum / 32;
    };
    session->draw(2);
    const double full = mean_after_a_cut(1);
    ASSERT_GT(full, 0);
    EXPECT_NEAR(mean_after_a_cut(0.25f) / full, 0.25, 0.02);
    EXPECT_LT(mean_after_a_cut(0) / full, 1e-6);
    EXPECT_NEAR(mean_after_a_cut(1) / full, 1, 0.05);
}

// A light that is dark when the map begins has no first value: rays look for themselves until it has one.
TEST_F(LightCache, DoesNotMissLightsThatComeLater)
{
    add_room(blinking_style);
    const auto session = start({ { "flt_denoiser", "temporal" }, { "pt_seed", "0" } });
    session->light_style(blinking_style, 0);
    session->draw(4);
    session->light_style(blinking_style, 1);
    const Radiance expected = session->accumulate(2048);
    session->set("pt_accumulate", "0");
    double sum = 0;
    for (int i = 0; i < 64; i++) {
        session->view.time += 100;
        session->draw();
        sum += luminance(session->capture().mean());
    }
    EXPECT_NEAR(sum / 64 / luminance(expected.mean()), 1, 0.05);
}

TEST_F(LightCache, PassesNoWall)
{
    MapBuilder map;
    const uint16_t wall = map.add_material("wall");
    map.add_room({ -256, -128, 0 }, { -1, 128, 128 }, wall);
    map.add_room({ 1, -128, 0 }, { 256, 128, 128 }, wall);
    map.add_point_light({ -100, 0, 64 }, 300);
    folder_.add_map("two", map.finish());
    const auto session = start({ { "flt_denoiser", "temporal" } }, "two");
    session->look({ -200, -60, 64 }, { -20, 40, 40 });
    session->draw(20);
    const float lit = luminance(session->capture().mean());
    session->look({ 240, -60, 64 }, { 20, 40, 40 });
    session->draw(20);
    EXPECT_LE(luminance(session->capture().mean()), 1e-3f * lit);
}

// It is aimed by the cache, and does not read it: the same mean from half as many frames, with less noise.
TEST_F(LightCache, LetsPhotoModeConvergeToTheSame)
{
    add_room(0);
    const auto session = start({ { "flt_denoiser", "asvgf" } });
    session->set("pt_indirect", "trace");
    const Radiance traced = session->accumulate(4096);
    const Radiance short_traced = session->accumulate(64);
    session->set("pt_indirect", "cache");
    const Radiance aimed = session->accumulate(2048);
    EXPECT_NEAR(luminance(aimed.mean()) / luminance(traced.mean()), 1, 0.01);
    const std::vector<float> errors = block_errors(aimed, traced, glm::ivec2(16));
    EXPECT_LT(errors.back(), 0.05);
    EXPECT_LT(error_between(session->accumulate(64), aimed), 0.5 * error_between(short_traced, traced));
}

// Two lamps, of which the cache knows both when one is muted.
class WrongLightCache : public LightCache {
protected:
    WrongLightCache()
    {
        MapBuilder map;
        const uint16_t wall = map.add_material("wall");
        map.add_room({ -256, -256, 0 }, { 256, 256, 192 }, wall);
        map.add_block({ -200, -100, 0 }, { -192, 100, 160 }, wall);
        map.add_point_light({ -248, -20, 80 }, 200);
        map.add_point_light({ -248, 20, 80 }, 200);
        folder_.add_map("lamps", map.finish());
    }

    // By the command that works on the lights under the crosshair.
    static void mute_one(Session& session)
    {
        session.host().run_text("pt_lights\npt_lights mute 1\n");
        ASSERT_TRUE(session.has_line("is muted")) << session.lines().back();
    }
};

// pt_indirect both: the corrected mean is right, with any share and with samplers whose rays share light by MIS. A shot
// is not in the cache at all.
TEST_F(WrongLightCache, IsCorrectedToTheMeanOfTracing)
{
    const engine::DynamicLight shot { { 0, 150, 100 }, { 1, 0.6f, 0.3f }, 150 };
    Radiance traced;
    for (const auto& [sampler, share] :
        { std::pair("subset_pps", 0.25), { "subset_pps", 1.0 }, { "subset_mis", 0.25 } }) {
        const auto session = start({ { "flt_denoiser", "asvgf" }, { "pt_light_sampler", sampler } }, "lamps");
        session->draw(4);
        mute_one(*session);
        session->view.dlights = &shot;
        session->view.dlight_count = 1;
        session->set("pt_cache_corrected", share);
        if (traced.pixels.empty()) {
            session->set("pt_indirect", "trace");
            traced = session->accumulate(2048);
        }
        session->set("pt_indirect", "both");
        const Radiance corrected = session->accumulate(1024);
        EXPECT_NEAR(luminance(corrected.mean()) / luminance(traced.mean()), 1, 0.01) << sampler << " " << share;
        EXPECT_LT(block_errors(corrected, traced, glm::ivec2(16)).back(), 0.06) << sampler << " " << share;
    }
}

// The picture of the bias: little where the cache knows the light, in red half of it where one of the lamps is off
// since, and in blue when it is back after the cache has followed.
TEST_F(WrongLightCache, IsShown)
{
    const auto session = start({ { "flt_denoiser", "asvgf" } }, "lamps");
    session->draw(4);
    const float known = luminance(session->accumulate(512).mean());
    session->set("pt_accumulate", 0);
    session->set("pt_indirect", "both");
    session->draw(4);
    session->set("pt_debug_view", "cache_bias");
    const auto measure = [&] { return luminance(session->accumulate(24).mean()) / known; };
    const auto mean_display = [&] {
        glm::vec3 sum(0);
        for (const formats::Rgba8& pixel : session->capture_display().pixels)
            sum += glm::vec3(pixel.r, pixel.g, pixel.b);
        return sum;
    };
    EXPECT_NEAR(luminance(session->accumulate(2048).mean()) / known, 0, 0.03);
    mute_one(*session);
    const float bias = measure(); // in fewer frames than the cache takes to follow
    EXPECT_GT(bias, 0.3f);
    EXPECT_LT(bias, 0.51f);
    EXPECT_GT(mean_display().x, 4 * mean_display().z);
    session->draw(300);
    session->host().run_text("pt_lights all\n");
    EXPECT_LT(measure(), -0.2);
    EXPECT_GT(mean_display().z, 4 * mean_display().x);

    session->set("pt_indirect", "cache"); // averaged pictures do not read it then: stripes
    session->accumulate(4);
    const formats::Image stripes = session->capture_display();
    EXPECT_FALSE(stripes.at(32, 40) == stripes.at(40, 40));
}

// The first frame, without a cache yet, is a picture, and is not averaged with the bias.
TEST_F(WrongLightCache, IsShownWithoutThePicture)
{
    const auto session = start({ { "flt_denoiser", "asvgf" }, { "pt_debug_view", "cache_bias" } }, "lamps");
    session->set("pt_indirect", "both");
    const float bias = std::abs(luminance(session->accumulate(8).mean()));
    session->set("pt_debug_view", "off");
    EXPECT_LT(bias, 0.06f * luminance(session->accumulate(256).mean()));
}

// Its own samples read tables that other samplers do without: at the start of a map, and where it is switched on later.
TEST_F(LightCache, HasItsTablesWithAnySampler)
{
    add_room(0);
    for (const char* sampler : { "subset", "light_tree" }) {
        const auto session = start({ { "flt_denoiser", "temporal" }, { "pt_light_sampler", sampler } });
        session->draw(4);
        const float cached = luminance(session->capture().mean());
        EXPECT_GT(cached, 0) << sampler;
        session->set("pt_indirect", "trace");
        session->load_map("room");
        session->look({ 240, -200, 120 }, { -180, 60, 40 });
        session->draw(4);
        session->set("pt_indirect", "cache");
        session->draw(32);
        EXPECT_NEAR(luminance(session->capture().mean()) / cached, 1, 0.5) << sampler;
    }
}

} // namespace
} // namespace vkpt::tests
