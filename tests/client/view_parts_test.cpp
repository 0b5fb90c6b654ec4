// SPDX-License-Identifier: GPL-2.0-or-later
// The viewer without its window: camera, divider, settings, errors, graphs, and who is drawn next.
#include "client/view/actions.hpp"
#include "client/view/error.hpp"
#include "client/view/fly_camera.hpp"
#include "client/view/graph.hpp"
#include "client/view/settings.hpp"
#include "client/view/split.hpp"
#include "client/view/viewer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

namespace vkpt::client::view {
namespace {

void expect_near(glm::vec3 actual, glm::vec3 expected)
{
    EXPECT_LT(glm::distance(actual, expected), 1e-3f)
        << actual.x << " " << actual.y << " " << actual.z << " instead of " << expected.x << " " << expected.y << " "
        << expected.z;
}

TEST(FlyCamera, FliesWhereItLooks)
{
    const Camera east { { 0, 0, 0 }, 0, 0 }, north { { 0, 0, 0 }, 0, 90 }, down { { 0, 0, 0 }, 30, 0 };
    expect_near(fly(east, { { 1, 0, 0 } }, 100, 0.5f).position, { 50, 0, 0 });
    expect_near(fly(north, { { 1, 0, 0 } }, 100, 0.5f).position, { 0, 50, 0 });
    expect_near(fly(down, { { 1, 0, 0 } }, 100, 1).position, { 100 * std::cos(0.5235988f), 0, -50 });
    expect_near(fly(north, { { 0, 1, 0 } }, 100, 1).position, { 100, 0, 0 }); // east is right of north
    expect_near(fly(down, { { 0, 0, 1 } }, 100, 1).position, { 0, 0, 100 }); // up is the world's
}

TEST(FlyCamera, IsNoFasterDiagonally)
{
    const glm::vec3 moved = fly({}, { { 1, 1, 1 } }, 100, 1).position;
    EXPECT_NEAR(glm::length(moved), 100, 1e-3);
    EXPECT_NEAR(glm::length(fly({}, { { 0.5f, 0, 0 } }, 100, 1).position), 50, 1e-3);
}

TEST(FlyCamera, TurnsRoundAboutButNotHeadOver)
{
    Camera camera;
    for (int i = 0; i < 100; i++) {
        camera = fly(camera, { {}, 7, 3 }, 0, 0);
        EXPECT_LE(std::abs(camera.pitch), 89.0f);
        EXPECT_LE(std::abs(camera.yaw), 180.0f);
    }
    EXPECT_FLOAT_EQ(camera.pitch, 89);
    EXPECT_NEAR(camera.yaw, std::remainder(700.0, 360.0), 1e-3);
}

// A trace's own camera is followed until the user moves it.
TEST(FlyCamera, StaysWhereNobodyMovesIt)
{
    const Camera recorded { { 1, 2, 3 }, 90, 270 }, same = fly(recorded, {}, 320, 0.1f);
    EXPECT_EQ(same.position, recorded.position);
    EXPECT_EQ(same.pitch, 90);
    EXPECT_EQ(same.yaw, 270);
}

TEST(Split, FitsThePictureIntoTheRoom)
{
    const Area wide = fit_picture({ 0, 0, 1000, 300 }, { 400, 200 });
    EXPECT_EQ(wide.height, 300);
    EXPECT_EQ(wide.width, 600);
    EXPECT_EQ(wide.x, 200);
    const Area nearly = fit_picture({ 10, 20, 410, 215 }, { 400, 200 });
    EXPECT_EQ(nearly.width, 400) << "a little enlargement would only blur";
    EXPECT_EQ(nearly.x, 15);
    EXPECT_EQ(nearly.y, 27);
    EXPECT_EQ(fit_picture({ 0, 0, 100, 100 }, { 0, 0 }).width, 0);
}

TEST(Split, FindsThePixelUnderThePoint)
{
    const Area shown { 100, 50, 200, 100 };
    EXPECT_EQ(find_pixel(shown, { 400, 200 }, { 100, 50 }), glm::ivec2(0, 0));
    EXPECT_EQ(find_pixel(shown, { 400, 200 }, { 299.9f, 149.9f }), glm::ivec2(399, 199));
    EXPECT_EQ(find_pixel(shown, { 400, 200 }, { 200, 100 }), glm::ivec2(200, 100));
    EXPECT_FALSE(find_pixel(shown, { 400, 200 }, { 99, 60 }));
    EXPECT_FALSE(find_pixel(shown, { 400, 200 }, { 300, 60 }));
}

TEST(Split, DividerIsDraggedAndStaysInside)
{
    const Area shown { 100, 50, 200, 100 };
    Split split;
    EXPECT_EQ(split.columns_of_a(200), 200) << "all is A's while the split is off";
    EXPECT_FALSE(split.is_at_divider(shown, { 200, 60 }));
    split.is_on = true;
    EXPECT_EQ(split.columns_of_a(200), 100);
    EXPECT_TRUE(split.is_at_divider(shown, { 204, 60 }));
    EXPECT_FALSE(split.is_at_divider(shown, { 210, 60 }));
    EXPECT_FALSE(split.is_at_divider(shown, { 200, 40 }));
    split.drag_to(shown, { 150, 0 });
    EXPECT_EQ(split.columns_of_a(200), 100) << "nobody holds it";
    split.begin_drag();
    split.drag_to(shown, { 150, 0 });
    EXPECT_EQ(split.columns_of_a(200), 50);
    split.drag_to(shown, { 5000, 0 });
    split.end_drag();
    EXPECT_LT(split.columns_of_a(200), 200);
    EXPECT_GT(split.columns_of_a(200), 190);
}

TEST(Split, PutsBothSidesTogether)
{
    constexpr formats::Rgba8 red { 255, 0, 0, 255 }, blue { 0, 0, 255, 255 };
    const formats::Image a { 8, 2, std::vector<formats::Rgba8>(16, red) },
        b { 8, 2, std::vector<formats::Rgba8>(16, blue) };
    Split split;
    EXPECT_EQ(compose(a, b, split).pixels, a.pixels);
    split.is_on = true;
    split.set_place(0.25f);
    const formats::Image both = compose(a, b, split);
    for (int y = 0; y < 2; y++) {
        EXPECT_EQ(both.at(1, y), red);
        EXPECT_EQ(both.at(2, y), (formats::Rgba8 { 255, 255, 255, 255 }));
        EXPECT_EQ(both.at(3, y), blue);
    }
    EXPECT_EQ(compose(a, {}, split).pixels, a.pixels) << "B has no picture yet";
}

class LiveSettings : public testing::Test {
protected:
    const std::vector<LiveSetting> live = find_live_settings({ "full", "subset", "uniform" });
    const LiveSetting& get(std::string_view name) const { return *find_setting(live, name); }
};

TEST_F(LiveSettings, ComeFromTheTable)
{
    for (const char* name : { "pt_light_sampler", "pt_light_subset", "pt_bounces", "flt_denoiser", "pt_trace",
             "pt_debug_view", "pt_accumulate", "pt_exposure_bias" })
        ASSERT_TRUE(find_setting(live, name)) << name;
    for (const char* name : { "pt_device", "pt_validation", "pt_capture_dir", "r_mode", "no_such_setting" })
        EXPECT_FALSE(find_setting(live, name)) << name;
    EXPECT_EQ(get("pt_light_sampler").choices, (std::vector<std::string> { "full", "subset", "uniform" }));
    for (const char* view :
        { "albedo", "normal", "depth", "motion", "cluster", "list_length", "variance", "gradient", "alpha", "rays" })
        EXPECT_TRUE(std::ranges::count(get("pt_debug_view").choices, view)) << view;
    EXPECT_TRUE(get("pt_bounces").is_short());
    EXPECT_FALSE(get("pt_seed").is_short());
}

TEST_F(LiveSettings, StepThroughTheirValues)
{
    EXPECT_EQ(step_value(get("pt_light_sampler"), "full", 1), "subset");
    EXPECT_EQ(step_value(get("pt_light_sampler"), "full", -1), "uniform");
    EXPECT_EQ(step_value(get("pt_light_sampler"), "gone", 1), "full");
    EXPECT_EQ(step_value(get("pt_bounces"), "1", 1), "2");
    EXPECT_EQ(step_value(get("pt_bounces"), "0", -1), "0");
    EXPECT_EQ(step_value(get("pt_bounces"), "8", 1), "8");
    EXPECT_EQ(step_value(get("pt_emission_scale"), "1", 1), "1.25");
    EXPECT_EQ(step_value(get("pt_emission_scale"), "1000", 1), "1000");
    EXPECT_EQ(step_value(get("pt_exposure"), "0", 1), "1");
    EXPECT_EQ(step_value(get("pt_exposure_bias"), "0", -1), "-0.25");
    EXPECT_EQ(double_value(get("pt_light_subset"), "8", 1), "16");
    EXPECT_EQ(double_value(get("pt_light_subset"), "1", -1), "1");
    EXPECT_EQ(double_value(get("pt_light_subset"), "64", 1), "64");
}

TEST_F(LiveSettings, ReferenceIsUnfilteredAndUnbiased)
{
    Settings settings;
    for (const LiveSetting& setting : live)
        settings[setting.name] = setting.initial;
    settings["pt_light_sampler"] = "uniform";
    settings["pt_max_radiance"] = "3";
    settings["pt_bounces"] = "2";
    settings["pt_emission_scale"] = "5";
    const Settings reference = reference_settings(settings, live);
    EXPECT_EQ(reference.at("pt_light_sampler"), "subset_pps");
    EXPECT_EQ(reference.at("pt_max_radiance"), "0");
    EXPECT_EQ(reference.at("flt_denoiser"), "off");
    EXPECT_EQ(reference.at("flt_taa"), "off");
    EXPECT_EQ(reference.at("pt_accumulate"), "1");
    EXPECT_EQ(reference.at("pt_bounces"), "2") << "bounces decide about the picture itself";
    EXPECT_EQ(reference.at("pt_emission_scale"), "5");
}

// The mean of n normal deviates of deviation 1 about 2 is off by 1 / (2 sqrt(n)) of itself.
TEST(Error, ReferenceKnowsHowFarItIsOff)
{
    std::mt19937 random(1);
    std::normal_distribution<double> deviate;
    std::vector<double> sum(20000);
    analysis::LinearImage average = analysis::make_image(200, 100);
    Reference reference;
    EXPECT_FALSE(reference.own_rmse());
    for (uint32_t n = 1; n <= 24; n++) {
        for (size_t i = 0; i < sum.size(); i++) {
            sum[i] += 2 + deviate(random);
            std::fill_n(&average.rgb[3 * i], 3, float(sum[i] / n));
        }
        reference.update(average, n);
        if (n == 1) {
            EXPECT_FALSE(reference.own_rmse());
        } else {
            EXPECT_NEAR(*reference.own_rmse(), 0.5 / std::sqrt(double(n)), 0.02 / std::sqrt(double(n))) << n;
        }
    }
    reference.update(average, 1); // fewer frames: another average
    EXPECT_EQ(reference.frames(), 1u);
    EXPECT_FALSE(reference.own_rmse());
    reference.update(average, 2);
    EXPECT_EQ(*reference.own_rmse(), 0);
    reference.update(analysis::make_image(100, 200), 3); // another size
    EXPECT_FALSE(reference.own_rmse());
}

TEST(Keys, F5AsksForEditedShaders)
{
    State state;
    SDL_KeyboardEvent event {};
    event.keysym.sym = SDLK_F5;
    EXPECT_TRUE(run_key(state, event));
    EXPECT_TRUE(state.must_reload_shaders);
}

TEST(Passes, MediansAndTotals)
{
    PassHistory history;
    for (int i = 0; i < 5; i++)
        history.add({ { "direct_light", double(i) }, { "tone_map", 1 } });
    history.add({ { "direct_light", 100 }, { "denoise", 7 } });
    EXPECT_EQ(history.names(), (std::vector<std::string> { "direct_light", "tone_map", "denoise" }));
    EXPECT_EQ(history.median("direct_light"), 2);
    EXPECT_EQ(history.median("denoise"), 7) << "frames without the pass do not count";
    EXPECT_EQ(history.median("nothing"), 0);
    EXPECT_EQ(history.total(5), 107);
    EXPECT_EQ(history.milliseconds(5, "tone_map"), 0);
    for (size_t i = 0; i < 2 * kept_frames; i++)
        history.add({ { "tone_map", 1 } });
    EXPECT_EQ(history.size(), kept_frames);
    EXPECT_EQ(history.names(), (std::vector<std::string> { "tone_map" }));
}

TEST(Passes, ScaleIsThatOfMostFrames)
{
    PassHistory history;
    EXPECT_EQ(history.scale(), 1);
    history.add({ { "direct_light", 90000 } });
    for (int i = 0; i < 20; i++)
        history.add({ { "direct_light", 40 } });
    EXPECT_EQ(history.scale(), 100);
}

TEST(Passes, ScaleIsRound)
{
    EXPECT_EQ(round_up(3.2), 5);
    EXPECT_EQ(round_up(0.11), 0.2);
    EXPECT_EQ(round_up(51), 100);
    EXPECT_EQ(round_up(100), 100);
    EXPECT_EQ(round_up(0), 1);
}

TEST(Turns, GoRound)
{
    Turns turns;
    EXPECT_EQ(turns.next(false, false), Side::a);
    EXPECT_EQ(turns.next(false, false), Side::a);
    EXPECT_EQ(turns.next(true, false), Side::b);
    EXPECT_EQ(turns.next(true, false), Side::a);
    EXPECT_EQ(turns.next(true, true), Side::b);
    EXPECT_EQ(turns.next(true, true), Side::reference);
    EXPECT_EQ(turns.next(true, true), Side::a);
    EXPECT_EQ(turns.next(false, true), Side::reference);
    EXPECT_EQ(turns.next(false, true), Side::a);
}

} // namespace
} // namespace vkpt::client::view
