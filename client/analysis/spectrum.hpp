// SPDX-License-Identifier: GPL-2.0-or-later
// How the error of a picture is spread over frequencies.
#pragma once

#include <cstddef>
#include <vector>

namespace vkpt::analysis {

// Mean power of a square picture (side: a power of two) in bands of radial frequency, mean 0. White noise of variance v
// has power v in every band. Entry i covers i/64 .. (i + 1)/64 cycles per pixel, up to Nyquist's 1/2: 32 entries.
struct Spectrum {
    std::vector<double> power;
    double low = 0; // mean over 0 < f < 1/8
    double high = 0; // mean over f >= 1/8, the corners beyond Nyquist included
    double low_to_high() const { return high > 0 ? low / high : 0; } // white noise: 1
};

Spectrum measure_spectrum(const std::vector<double>& picture, size_t side);

// The mean of several pictures' spectra.
Spectrum measure_spectrum(const std::vector<std::vector<double>>& pictures, size_t side);

// Of pictures of any shape: the mean over tiles of `spectrum_tile` pixels square, each brought to variance 1 first, so
// that the few places with the largest error do not stand for all. What is left over at the right and lower edge, and
// tiles without any error, do not count; without any tile `power` is empty.
inline constexpr size_t spectrum_tile = 32;
Spectrum measure_tiled_spectrum(const std::vector<std::vector<double>>& pictures, size_t width, size_t height);
// The mean of spectra that have `power`.
Spectrum average_spectra(const std::vector<Spectrum>& spectra);

} // namespace vkpt::analysis
