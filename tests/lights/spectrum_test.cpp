// SPDX-License-Identifier: GPL-2.0-or-later
// What blue noise makes of each sampler's error at one sample per pixel: low by high frequencies, white noise = 1.
#include "ref_vkpt/noise/blue_noise.hpp"
#include "spectrum_scene.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace vkpt::test {
namespace {

constexpr size_t light_count = 64;
constexpr int frames = 2;
constexpr float rough = 0.8f, glossy = 0.2f;
const uint32_t* const blue = blue_noise_words.data();

class SpectrumOfError : public testing::Test {
protected:
    static SpectrumScene::Error measure(
        std::string_view name, int weight, const uint32_t* masks = blue, float roughness = rough)
    {
        static const SpectrumScene rough_scene(light_count, rough, 1), glossy_scene(light_count, glossy, 1);
        const SpectrumScene::Error error = (roughness == rough ? rough_scene : glossy_scene)
                                               .measure(find_sampler(name), { 8, weight }, masks, frames);
        fmt::print("{:16} {:8} {:6} roughness {}: low/high {:.3f}, variance {:.4f}, mean {:+.4f}\n", name,
            weight == shared::LIGHT_WEIGHT_LTC ? "ltc" : "brdf_centre", masks ? "blue" : "white", roughness,
            error.spectrum.low_to_high(), error.variance, error.bias);
        // Independent numbers would let the mean stray by this much.
        EXPECT_LT(std::abs(error.bias),
            5 * std::sqrt(error.variance / double(frames * SpectrumScene::side * SpectrumScene::side)));
        return error;
    }
};

TEST_F(SpectrumOfError, IsWhiteUnderWhiteNoise)
{
    for (const char* name : { "uniform", "subset", "subset_mis_blue" })
        EXPECT_NEAR(measure(name, shared::LIGHT_WEIGHT_BRDF_CENTRE, nullptr).spectrum.low_to_high(), 1, 0.15) << name;
}

TEST_F(SpectrumOfError, OfSubsetIsBlue)
{
    for (const int weight : { shared::LIGHT_WEIGHT_BRDF_CENTRE, shared::LIGHT_WEIGHT_LTC })
        for (const char* name : { "subset", "subset_onesweep" })
            EXPECT_LT(measure(name, weight).spectrum.low_to_high(), 0.35) << name;
}

// The chapter's open problem.
TEST_F(SpectrumOfError, OfPseudoMarginalMisIsWhite)
{
    EXPECT_GT(measure("subset_mis", shared::LIGHT_WEIGHT_BRDF_CENTRE).spectrum.low_to_high(), 0.8);
    EXPECT_GT(measure("subset_strides", shared::LIGHT_WEIGHT_BRDF_CENTRE).spectrum.low_to_high(), 0.8);
}

TEST_F(SpectrumOfError, OfSubsetMisBlueIsBlueAndNoHigher)
{
    for (const float roughness : { rough, glossy })
        for (const int weight : { shared::LIGHT_WEIGHT_BRDF_CENTRE, shared::LIGHT_WEIGHT_LTC }) {
            const SpectrumScene::Error ours = measure("subset_mis_blue", weight, blue, roughness);
            const SpectrumScene::Error theirs = measure("subset_mis", weight, blue, roughness);
            EXPECT_LT(ours.spectrum.low_to_high(), weight == shared::LIGHT_WEIGHT_LTC ? 0.25 : 0.55);
            EXPECT_LT(ours.variance, theirs.variance);
        }
}

} // namespace
} // namespace vkpt::test
