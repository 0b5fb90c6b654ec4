// SPDX-License-Identifier: GPL-2.0-or-later
// Views that are drawn in turn keep their pictures apart, and a pixel's lights have the probabilities that they are
// picked with.
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace vkpt::tests {
namespace {

class Inspection : public testing::Test {
protected:
    Inspection()
    {
        folder_.add_wall("wall", 180);
        folder_.add_wall("lamp", white_index);
        MapBuilder map;
        map.add_room({ -128, -128, 0 }, { 128, 128, 128 }, map.add_material("wall"));
        const uint16_t lamp = map.add_material("lamp", 0, 1000);
        for (int i = 0; i < 5; i++)
            map.add(rectangle({ 40 * i - 80, 20, 127 }, { 0, 3 + 4 * i, 0 }, { 8, 0, 0 }), lamp);
        map.add_point_light({ -90, 90, 60 }, 100);
        folder_.add_map("room", map.finish());
        session_ = std::make_unique<Session>(folder_, CvarList { { "pt_light_subset", "3" } });
        session_->load_map("room");
        session_->look({ -100, -100, 80 }, { 60, 60, 20 });
    }

    bool inspect(glm::uvec2 pixel)
    {
        lights_.assign(64, {});
        const bool found
            = session_->extension().inspect_pixel(pixel.x, pixel.y, &surface_, lights_.data(), lights_.size());
        lights_.resize(std::min<size_t>(surface_.light_count, lights_.size()));
        return found;
    }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
    InspectedSurface surface_ {};
    std::vector<InspectedLight> lights_;
};

// Alone or in turns: the same pictures, bit for bit. Without guides, which are chosen once for all views.
TEST_F(Inspection, ViewsKeepTheirAveragesApart)
{
    session_->set("pt_indirect", "trace");
    const auto draw_view = [&](uint32_t view, const char* sampler) {
        ASSERT_TRUE(session_->extension().select_view(view));
        session_->set("pt_light_sampler", sampler);
        session_->draw();
    };
    session_->set("pt_accumulate", 1);
    Radiance alone[2];
    for (int run = 0; run < 2; run++) {
        session_->extension().thaw_scene();
        session_->set("pt_light_sampler", run == 0 ? "subset" : "uniform");
        session_->draw(6);
        alone[run] = session_->capture();
    }
    EXPECT_FALSE(alone[0] == alone[1]);
    for (int frame = 0; frame < 6; frame++) {
        draw_view(1, "subset");
        draw_view(2, "uniform");
    }
    EXPECT_EQ(session_->extension().accumulated_frames(), 6u);
    EXPECT_TRUE(session_->capture() == alone[1]);
    ASSERT_TRUE(session_->extension().select_view(1));
    EXPECT_EQ(session_->extension().accumulated_frames(), 6u);
    EXPECT_TRUE(session_->capture() == alone[0]);
    EXPECT_FALSE(session_->extension().select_view(view_count));
}

// A frozen view shows its own lights, whatever comes and goes in the others.
TEST_F(Inspection, FrozenViewKeepsItsLights)
{
    std::vector<engine::DynamicLight> shots(20, { { 0, 0, 60 }, { 1, 0.5f, 0.2f }, 300 });
    session_->extension().select_view(1);
    session_->set("pt_accumulate", 1);
    session_->view.dlights = shots.data();
    session_->view.dlight_count = int(shots.size());
    session_->draw(4);
    const Radiance lit = session_->capture();
    session_->extension().select_view(0);
    session_->set("pt_accumulate", 0);
    session_->view.dlight_count = 0;
    session_->draw(3);
    EXPECT_LT(luminance(session_->capture().mean()), 0.9f * luminance(lit.mean()));
    session_->extension().select_view(1);
    session_->set("pt_accumulate", 1);
    session_->draw(4);
    EXPECT_EQ(session_->extension().accumulated_frames(), 8u);
    EXPECT_NEAR(luminance(session_->capture().mean()), luminance(lit.mean()), 0.1f * luminance(lit.mean()));
    session_->load_map("room"); // gives all views back
    session_->draw(2);
}

TEST_F(Inspection, ProbabilitiesAreThoseOfThePicks)
{
    EXPECT_FALSE(inspect({ 1, 1 })) << "nothing has been drawn";
    // Of a sampler whose probability depends on random numbers, each seed knows the average over 64 of them.
    constexpr int seeds = 32;
    constexpr size_t light_count = 11; // five lamps of two triangles, and the point light
    for (const std::string sampler : { "uniform", "subset", "subset_mis" }) {
        session_->set("pt_light_sampler", sampler);
        struct Sums {
            double told = 0, squares = 0, picked = 0;
        };
        std::array<Sums, light_count> sums {};
        double choices = 0;
        for (int seed = 1; seed <= seeds; seed++) {
            session_->set("pt_seed", seed);
            session_->draw();
            ASSERT_TRUE(inspect({ 32, 40 })) << sampler; // the floor
            EXPECT_GT(surface_.depth, 0);
            EXPECT_NEAR(surface_.normal[2], 1, 1e-3);
            EXPECT_NEAR(surface_.position[2], 0, 0.1);
            ASSERT_EQ(lights_.size(), light_count) << sampler;
            ASSERT_GT(surface_.choices, 10000u);
            choices += surface_.choices;
            for (size_t i = 0; i < light_count; i++) {
                const InspectedLight& light = lights_[i];
                EXPECT_TRUE(i == 0 || light.emitter > lights_[i - 1].emitter);
                EXPECT_GT(light.weight, 0);
                EXPECT_GT(light.radiance[0], 0);
                sums[i].told += double(light.probability);
                sums[i].squares += double(light.probability) * double(light.probability);
                sums[i].picked += light.picked;
            }
        }
        double sum = 0;
        for (size_t i = 0; i < light_count; i++) {
            const double told = sums[i].told / seeds, picked = sums[i].picked / choices;
            const double told_variance = std::max(sums[i].squares / seeds - told * told, 0.0) / (seeds - 1);
            const double sigma = std::sqrt(told_variance + picked * (1 - picked) / choices);
            EXPECT_NEAR(told, picked, 5 * sigma + 1e-4) << sampler << ", light " << i;
            EXPECT_LT(sigma, 0.01) << sampler << ", light " << i << ": too noisy to tell";
            sum += told;
            if (sampler == "uniform") {
                EXPECT_NEAR(told, 1.0 / light_count, 1e-6);
            }
        }
        EXPECT_NEAR(sum, 1, sampler == "subset_mis" ? 0.02 : 1e-3) << sampler;
    }
    session_->set("pt_seed", 1);
    EXPECT_FALSE(inspect({ 64, 1 })) << "beside the picture";
}

// In each size that a view is rendered in, and after a menu's smaller one: the same place, to a pixel of that size.
TEST_F(Inspection, FindsTheSamePlaceInEveryRenderSize)
{
    constexpr std::array<glm::uvec2, 4> pixels { { { 32, 40 }, { 5, 44 }, { 60, 30 }, { 20, 20 } } }; // away from edges
    session_->set("flt_denoiser", "asvgf");
    session_->set("pt_seed", 0);
    const auto look = [&] {
        std::array<InspectedSurface, pixels.size()> seen {};
        for (size_t i = 0; i < pixels.size(); i++) {
            EXPECT_TRUE(inspect(pixels[i]));
            seen[i] = surface_;
        }
        return seen;
    };
    session_->draw(3);
    const auto whole = look();
    for (const char* filter : { "on", "upscale" })
        for (const int scale : { 67, 50 }) {
            session_->set("flt_taa", filter);
            session_->set("pt_render_scale", scale);
            session_->draw(3);
            const auto seen = look();
            for (size_t i = 0; i < pixels.size(); i++)
                EXPECT_LT(glm::distance(seen[i].position, whole[i].position), 0.12f * whole[i].depth)
                    << filter << ' ' << scale << ' ' << i;
        }
    const auto before = look();
    engine::RefDef menu = session_->view;
    menu.flags = engine::RDF_NOWORLDMODEL;
    menu.width = menu.height = 16;
    const engine::Exports8& module = session_->module();
    module.begin_frame(0);
    module.render_frame(&menu);
    module.end_frame();
    const auto after = look();
    for (size_t i = 0; i < pixels.size(); i++)
        EXPECT_TRUE(after[i].position == before[i].position) << i;
}

// What is inspected is no part of the picture.
TEST_F(Inspection, LeavesTheAverageAlone)
{
    session_->set("pt_accumulate", 1);
    session_->draw(3);
    const Radiance before = session_->capture();
    ASSERT_TRUE(inspect({ 32, 40 }));
    EXPECT_EQ(session_->extension().accumulated_frames(), 3u);
    EXPECT_TRUE(session_->capture() == before);
    session_->draw();
    EXPECT_EQ(session_->extension().accumulated_frames(), 4u);
}

// Every debug view differs from the picture and from the others; those of the filters say so where these are off.
TEST_F(Inspection, DebugViewsShowSomethingOfTheirOwn)
{
    session_->set("flt_denoiser", "asvgf");
    session_->set("pt_seed", 0);
    std::vector<std::vector<formats::Rgba8>> seen;
    for (const char* name : { "off", "albedo", "normal", "depth", "emission", "cluster", "list_length", "irradiance",
             "roughness", "motion", "variance", "gradient", "alpha", "cache", "cache_bias", "rays" }) {
        session_->set("pt_debug_view", name);
        for (int frame = 0; frame < 2; frame++) {
            session_->view.view_angles[1] += 0.5f;
            session_->view.time += 0.016f;
            session_->draw();
        }
        seen.push_back(session_->capture_display().pixels);
        for (size_t other = 0; other + 1 < seen.size(); other++)
            EXPECT_FALSE(seen[other] == seen.back()) << name << " is as the view number " << other;
    }
    // Counted rays: every pixel of the room's inside has some, and more with more bounces.
    const auto mean = [](const std::vector<formats::Rgba8>& pixels) {
        double sum = 0;
        for (const formats::Rgba8& pixel : pixels)
            sum += pixel.r + pixel.g + pixel.b;
        return sum / double(pixels.size());
    };
    EXPECT_GT(mean(seen.back()), 10);
    session_->set("pt_bounces", 4);
    session_->draw();
    EXPECT_GT(mean(session_->capture_display().pixels), mean(seen.back()) + 10);
    session_->set("flt_denoiser", "off");
    session_->set("flt_taa", "off");
    session_->set("pt_debug_view", "variance");
    session_->draw();
    const formats::Image stripes = session_->capture_display();
    EXPECT_FALSE(stripes.at(32, 40) == stripes.at(40, 40));
    EXPECT_TRUE(stripes.at(32, 40) == stripes.at(48, 40));
}

} // namespace
} // namespace vkpt::tests
