// SPDX-License-Identifier: GPL-2.0-or-later
// How the error of a picture is spread over frequencies.
#pragma once

#include <cstddef>
#include <vector>

namespace vkpt::test {

// Mean power of a square picture (side: a power of two) in bands of radial frequency, mean 0. White noise of variance v
// has power v in every band. Entry i covers i/64 .. (i + 1)/64 cycles per pixel, up to Nyquist's 1/2: 32 entries.
struct Spectrum {
    std::vector<double> power;
    double low = 0; // mean over 0 < f < 1/8
    double high = 0; // mean over f >= 1/8, the corners beyond Nyquist included
    double low_to_high() const { return low / high; } // white noise: 1
};

Spectrum measure_spectrum(const std::vector<double>& picture, size_t side);

// The mean of several pictures' spectra.
Spectrum measure_spectrum(const std::vector<std::vector<double>>& pictures, size_t side);

} // namespace vkpt::test
