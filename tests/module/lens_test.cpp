// SPDX-License-Identifier: GPL-2.0-or-later
// The thin lens (pt_aperture, pt_focus): how wide a point is blurred, and that what is in focus is as without it.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

constexpr int width = 64, height = 48;

class Lens : public testing::Test {
protected:
    // A small square that shines, `distance` before the camera, in the dark.
    void look_at_spot(float distance, float half)
    {
        GameFolder folder;
        folder.add_wall("lamp", white_index);
        MapBuilder map;
        map.add(rectangle({ distance, 0, 0 }, { 0, 0, half }, { 0, half, 0 }), map.add_material("lamp", 0, 1000));
        folder.add_map("dark", map.finish());
        session_ = std::make_unique<Session>(
            folder, CvarList { { "pt_bounces", "0" }, { "pt_sky_scale", "0" } }, glm::ivec2(width, height));
        session_->load_map("dark");
        session_->look({ 0, 0, 0 }, { 1, 0, 0 });
    }

    Radiance photograph(float aperture, float focus, int frames)
    {
        session_->set("pt_aperture", aperture);
        session_->set("pt_focus", focus);
        return session_->accumulate(frames);
    }

    std::unique_ptr<Session> session_;
};

// Of the light's places along an axis of the picture, in pixels^2.
double variance(const Radiance& picture, bool along_x)
{
    double sum = 0, mean = 0, square = 0;
    for (int y = 0; y < picture.height; y++)
        for (int x = 0; x < picture.width; x++) {
            const double light = picture.at(x, y).y, place = along_x ? x : y;
            sum += light;
            mean += light * place;
            square += light * place * place;
        }
    EXPECT_GT(sum, 0);
    return square / sum - mean / sum * (mean / sum);
}

struct Setting {
    float aperture, focus, distance;
};

// Of an even disc of diameter c the variance along an axis is c^2 / 16, of a square of side s it is s^2 / 12, and of
// the pixel, 1 / 12; those of what is blurred by one another add up.
TEST_F(Lens, CircleOfConfusionIsThatOfAThinLens)
{
    constexpr float half = 4;
    for (const auto& [aperture, focus, distance] :
        { Setting { 40, 100, 200 }, Setting { 24, 100, 300 }, Setting { 24, 240, 120 }, Setting { 12, 400, 100 } }) {
        look_at_spot(distance, half);
        const Radiance picture = photograph(aperture, focus, 600);
        const double units_per_pixel = 2 * focus / width; // on the plane in focus; 90 degrees from side to side
        const double expected = aperture * std::abs(distance - focus) / distance / units_per_pixel;
        const double spot = 2 * half * focus / distance / units_per_pixel;
        for (const bool along_x : { true, false }) {
            const double circle = std::sqrt(16 * (variance(picture, along_x) - spot * spot / 12 - 1.0 / 12));
            EXPECT_NEAR(circle, expected, 0.03 * expected)
                << "lens " << aperture << ", focus " << focus << ", distance " << distance;
        }
        session_.reset();
    }
}

TEST_F(Lens, WhatIsInFocusIsSharp)
{
    look_at_spot(150, 20);
    const Radiance sharp = photograph(0, 150, 200), in_focus = photograph(30, 150, 200),
                   blurred = photograph(30, 100, 200);
    const double difference = error_between(in_focus, sharp);
    EXPECT_GT(error_between(blurred, sharp), 20 * difference);
    EXPECT_NEAR(variance(in_focus, true), variance(sharp, true), 0.02 * variance(sharp, true));
}

// The game's own pictures, which move, have no lens.
TEST_F(Lens, LivePicturesAreSharp)
{
    look_at_spot(150, 20);
    session_->set("pt_accumulate", 0);
    session_->draw();
    const Radiance before = session_->capture();
    session_->set("pt_aperture", 30);
    session_->set("pt_focus", 20);
    session_->draw();
    EXPECT_TRUE(session_->capture() == before);
}

} // namespace
} // namespace vkpt::tests
