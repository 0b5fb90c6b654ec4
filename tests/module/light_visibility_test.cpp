// SPDX-License-Identifier: GPL-2.0-or-later
// Lights weighed by what earlier shadow rays have told: less noise, the same light, also at once when a door opens.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

// Behind a screen, which a door can stand for, are 30 lamps that the rest of the room does not see; on this side is one
// dim lamp.
class LightVisibility : public testing::Test {
protected:
    LightVisibility() { folder_.add_wall("wall", 180); }

    void add_room(bool with_door)
    {
        MapBuilder map;
        const uint16_t wall = map.add_material("wall");
        map.add_room({ -256, -256, 0 }, { 256, 256, 128 }, wall);
        if (!with_door)
            map.add_block({ -8, -255, 1 }, { 8, 255, 127 }, wall);
        map.add_point_light({ 200, 0, 100 }, 60);
        for (int i = 0; i < 30; i++)
            map.add_point_light({ -200 + float(i % 6) * 20, -200 + float(i) * 13, 64 }, 200);
        if (with_door) {
            map.begin_brush_model();
            map.add_block({ -8, -255, 1 }, { 8, 255, 127 }, wall);
        }
        folder_.add_map("room", map.finish());
    }

    std::unique_ptr<Session> start(const char* visibility)
    {
        auto session = std::make_unique<Session>(folder_,
            CvarList { { "flt_denoiser", "temporal" }, { "flt_taa", "on" }, { "pt_seed", "0" }, { "pt_bounces", "0" },
                { "pt_light_visibility", visibility } });
        session->load_map("room");
        session->look({ 20, -200, 80 }, { 240, 100, 20 });
        return session;
    }

    GameFolder folder_;
};

// A frame without history: no filter has touched its light.
Radiance draw_after_cut(Session& session)
{
    session.view.time += 100;
    session.draw();
    return session.capture();
}

struct Noise {
    double mean = 0; // of the frames' luminance
    double error = 0; // of a frame, against `expected`
};

Noise measure_noise(Session& session, const Radiance& expected, int frames)
{
    Noise noise;
    for (int i = 0; i < frames; i++) {
        const Radiance picture = draw_after_cut(session);
        noise.mean += luminance(picture.mean()) / frames;
        noise.error += error_between(picture, expected) / frames;
    }
    return noise;
}

TEST_F(LightVisibility, LowersTheNoiseAndKeepsTheLight)
{
    add_room(false);
    const auto session = start("1");
    const Radiance expected = session->accumulate(2048);
    session->set("pt_accumulate", "0");
    const auto measure = [&](const char* visibility) {
        session->set("pt_light_visibility", visibility);
        session->draw(32);
        return measure_noise(*session, expected, 200);
    };
    const Noise without = measure("0"), with = measure("1");
    const float light = luminance(expected.mean());
    EXPECT_NEAR(without.mean / light, 1, 0.05);
    EXPECT_NEAR(with.mean / light, 1, 0.02);
    EXPECT_LT(with.error, 0.7 * without.error);
}

// The lamps behind the door are believed to be hidden, and light all the room in the frame in which it is gone.
TEST_F(LightVisibility, LightsInTheFrameInWhichADoorOpens)
{
    add_room(true);
    const auto session = start("1");
    engine::Entity door = make_entity(session->module().register_model("*1"), {});
    const float open = luminance(session->accumulate(1024).mean());
    session->set("pt_accumulate", "0");
    double first = 0;
    constexpr int times = 16;
    for (int i = 0; i < times; i++) {
        session->view.entities = &door;
        session->view.entity_count = 1;
        session->draw(40);
        EXPECT_LT(luminance(session->capture().mean()), 0.5 * open);
        session->view.entity_count = 0;
        first += luminance(draw_after_cut(*session).mean()) / times;
    }
    EXPECT_NEAR(first / open, 1, 0.05);
}

// At rest the weights change now and then. A-SVGF must not take that for a change of the light, or histories would be
// short.
TEST_F(LightVisibility, LooksLikeNoChangeOfTheLight)
{
    add_room(false);
    const auto session = start("1");
    session->set("flt_denoiser", "asvgf");
    session->set("flt_taa", "off");
    session->set("pt_debug_view", "gradient");
    session->draw();
    for (int frame = 1; frame < 40; frame++) {
        session->draw();
        EXPECT_TRUE(std::ranges::all_of(session->capture_display().pixels,
            [](const formats::Rgba8& pixel) { return pixel.r == 0 && pixel.g == 0; }))
            << "frame " << frame;
    }
}

} // namespace
} // namespace vkpt::tests
