// SPDX-License-Identifier: GPL-2.0-or-later
// A picture of a floor under lights that nothing hides, lit by a sampler at one sample per pixel, and the spectrum of
// its error.
#pragma once

#include "client/analysis/spectrum.hpp"
#include "sampler_case.hpp"

#include <cstdint>

namespace vkpt::test {

class SpectrumScene {
public:
    static constexpr size_t side = 128; // pixels
    // `light_count` triangles of random size, place and radiance above the floor.
    SpectrumScene(size_t light_count, float roughness, uint32_t seed);

    // Spectrum and variance of the relative error, over the pictures of several frames; the mean for bias.
    struct Error {
        analysis::Spectrum spectrum;
        double variance = 0, bias = 0;
    };
    Error measure(const Sampler& sampler, const SamplerOptions& options, const uint32_t* masks, int frames) const;

    const ListCase& list_at(size_t x, size_t y) const;

private:
    double truth_at(size_t x, size_t y) const;

    mutable ListCase list_;
    std::vector<double> truth_; // on a coarse grid
};

} // namespace vkpt::test
