// SPDX-License-Identifier: GPL-2.0-or-later
// How the module's error at one sample per pixel is spread over frequencies, low by high, where white noise is 1: blue
// noise must survive the light sampler. The scene hides nothing, so that only the choice of lights makes noise.
#include "client/analysis/spectrum.hpp"
#include "tests/module/map_builder.hpp"
#include "tests/module/session.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace vkpt::tests {
namespace {

constexpr int side = 128, light_count = 64;

class ModuleSpectrum : public testing::Test {
protected:
    ModuleSpectrum()
    {
        folder_.add_wall("floor", 170);
        folder_.add_wall("lamp", white_index);
        MapBuilder map;
        map.add(rectangle({ 0, 0, 0 }, { 300, 0, 0 }, { 0, 300, 0 }), map.add_material("floor"));
        const uint16_t lamps[]
            = { map.add_material("lamp", 0, 300), map.add_material("lamp", 0, 800), map.add_material("lamp", 0, 2000) };
        std::mt19937 rng(4);
        std::uniform_real_distribution<float> place(-110, 110), size(4, 14);
        for (int i = 0; i < light_count; i++) {
            // One triangle each, all in one plane above the eye: none hides another.
            const glm::vec3 centre(place(rng), place(rng), 140);
            const float half = size(rng);
            map.add({ centre + glm::vec3(-half, -half, 0), centre + glm::vec3(0, half, 0),
                        centre + glm::vec3(half, -half, 0) },
                lamps[i % 3]);
        }
        folder_.add_map("floor", map.finish());
        session_ = std::make_unique<Session>(folder_,
            CvarList { { "pt_accumulate", "1" }, { "pt_bounces", "0" }, { "pt_light_subset", "8" },
                { "pt_light_point", "projected" }, { "pt_roughness_default", "0.8" } },
            glm::ivec2(side));
        session_->load_map("floor");
        session_->look({ 0, -10, 100 }, { 0, 0, 0 });
        session_->set("pt_light_weight", "ltc");
        truth_ = draw("full", 1000, 80);
    }

    Radiance draw(const char* sampler, int seed, int frames)
    {
        session_->set("pt_light_sampler", sampler);
        session_->set("pt_seed", seed);
        session_->draw(frames);
        return session_->capture();
    }

    double measure(const char* sampler, const char* weight)
    {
        session_->set("pt_light_weight", weight);
        std::vector<std::vector<double>> errors;
        for (int seed = 1; seed <= 3; seed++) {
            const Radiance picture = draw(sampler, seed, 1);
            std::vector<double>& error = errors.emplace_back();
            for (size_t i = 0; i < picture.pixels.size(); i++)
                error.push_back(double(luminance(picture.pixels[i]) / luminance(truth_.pixels[i])) - 1);
        }
        const double ratio = analysis::measure_spectrum(errors, side).low_to_high();
        testing::Test::RecordProperty(std::string(sampler) + "_" + weight, std::to_string(ratio));
        return ratio;
    }

    GameFolder folder_;
    std::unique_ptr<Session> session_;
    Radiance truth_;
};

TEST_F(ModuleSpectrum, OfEachSamplerIsAsTold)
{
    ASSERT_FALSE(is_black(truth_));
    EXPECT_LT(measure("subset", "brdf_centre"), 0.35);
    EXPECT_GT(measure("subset_mis", "brdf_centre"), 0.8);
    EXPECT_LT(measure("subset_mis_blue", "brdf_centre"), 0.55);
    EXPECT_LT(measure("subset_mis_blue", "ltc"), 0.25);
    session_->set("pt_noise", "white");
    EXPECT_NEAR(measure("subset", "brdf_centre"), 1, 0.15);
}

} // namespace
} // namespace vkpt::tests
