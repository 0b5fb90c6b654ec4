// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/noise/blue_noise.hpp"
#include "spectrum_scene.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace vkpt::test {
namespace {

TEST(Spectrum, Explore)
{
    for (const size_t lights : { 8, 32, 64, 256 }) {
        const SpectrumScene scene(lights, 0.8f, 1);
        for (const Sampler& sampler : all_samplers())
            for (const int weight : { 0, 1 })
                for (const bool blue : { true, false }) {
                    const SpectrumScene::Error error
                        = scene.measure(sampler, { 8, weight, shared::LIGHT_POINT_SOLID_ANGLE }, blue ? blue_noise_words.data() : nullptr, 2);
                    fmt::print("K {:3} {:20} {:8} {:6}: low/high {:.3f}, variance {:.4f}, bias {:+.4f}\n", lights,
                        sampler.name, weight ? "ltc" : "chapter", blue ? "blue" : "white", error.spectrum.low_to_high(), error.variance, error.bias);
                }
    }
}

} // namespace
} // namespace vkpt::test
