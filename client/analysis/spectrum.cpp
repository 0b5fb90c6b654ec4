// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/analysis/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace vkpt::analysis {

namespace {

using Complex = std::complex<double>;
constexpr size_t bands = 32;
constexpr double low_limit = 1.0 / 8; // cycles per pixel

// In place, decimation in time; the length is a power of two.
void transform(std::vector<Complex>& line)
{
    const size_t n = line.size();
    for (size_t i = 1, reversed = 0; i < n; i++) {
        size_t bit = n / 2;
        for (; reversed & bit; bit /= 2)
            reversed ^= bit;
        reversed ^= bit;
        if (i < reversed)
            std::swap(line[i], line[reversed]);
    }
    for (size_t half = 1; half < n; half *= 2)
        for (size_t k = 0; k < half; k++) {
            const Complex turn = std::polar(1.0, -std::numbers::pi * double(k) / double(half));
            for (size_t i = k; i < n; i += 2 * half) {
                const Complex even = line[i], odd = turn * line[i + half];
                line[i] = even + odd;
                line[i + half] = even - odd;
            }
        }
}

std::vector<double> power_of(const std::vector<double>& picture, size_t side)
{
    if (picture.size() != side * side || side < 16 || (side & (side - 1)) != 0)
        throw std::invalid_argument("measure_spectrum wants a square picture whose side is a power of two");
    const double mean = std::accumulate(picture.begin(), picture.end(), 0.0) / double(picture.size());
    std::vector<Complex> values(picture.size());
    for (size_t i = 0; i < picture.size(); i++)
        values[i] = picture[i] - mean;
    std::vector<Complex> line(side);
    for (const size_t step : { size_t(1), side })
        for (size_t k = 0; k < side; k++) {
            const size_t start = step == 1 ? k * side : k;
            for (size_t i = 0; i < side; i++)
                line[i] = values[start + i * step];
            transform(line);
            for (size_t i = 0; i < side; i++)
                values[start + i * step] = line[i];
        }
    std::vector<double> power(values.size());
    for (size_t i = 0; i < values.size(); i++)
        power[i] = std::norm(values[i]) / double(values.size());
    return power;
}

// To mean 0 and variance 1. False: it is constant.
bool normalise(std::vector<double>& values)
{
    const double n = double(values.size()), mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double squares = 0;
    for (double& value : values) {
        value -= mean;
        squares += value * value;
    }
    const double deviation = std::sqrt(squares / n);
    for (double& value : values)
        value /= deviation > 0 ? deviation : 1;
    return deviation > 0;
}

} // namespace

Spectrum measure_spectrum(const std::vector<double>& picture, size_t side)
{
    return measure_spectrum(std::vector<std::vector<double>> { picture }, side);
}

Spectrum measure_spectrum(const std::vector<std::vector<double>>& pictures, size_t side)
{
    Spectrum spectrum;
    spectrum.power.assign(bands, 0);
    std::vector<double> counts(bands, 0);
    double low_count = 0, high_count = 0;
    const auto frequency = [&](size_t i) { return double(i < side / 2 ? i : side - i) / double(side); };
    for (const std::vector<double>& picture : pictures) {
        const std::vector<double> power = power_of(picture, side);
        for (size_t i = 1; i < power.size(); i++) {
            const double radius = std::hypot(frequency(i % side), frequency(i / side));
            const bool is_low = radius < low_limit;
            (is_low ? spectrum.low : spectrum.high) += power[i];
            (is_low ? low_count : high_count)++;
            const size_t band = size_t(radius * 2 * double(bands));
            if (band < bands) {
                spectrum.power[band] += power[i];
                counts[band]++;
            }
        }
    }
    spectrum.low /= low_count;
    spectrum.high /= high_count;
    for (size_t band = 0; band < bands; band++)
        spectrum.power[band] /= counts[band] > 0 ? counts[band] : 1;
    return spectrum;
}

Spectrum measure_tiled_spectrum(const std::vector<std::vector<double>>& pictures, size_t width, size_t height)
{
    constexpr size_t side = spectrum_tile;
    std::vector<std::vector<double>> tiles;
    for (const std::vector<double>& picture : pictures) {
        if (picture.size() != width * height)
            throw std::invalid_argument("measure_tiled_spectrum: a picture is of another size");
        for (size_t top = 0; top + side <= height; top += side)
            for (size_t left = 0; left + side <= width; left += side) {
                std::vector<double> tile(side * side);
                for (size_t y = 0; y < side; y++)
                    std::copy_n(&picture[(top + y) * width + left], side, &tile[y * side]);
                if (normalise(tile))
                    tiles.push_back(std::move(tile));
            }
    }
    return tiles.empty() ? Spectrum() : measure_spectrum(tiles, side);
}

Spectrum average_spectra(const std::vector<Spectrum>& spectra)
{
    Spectrum mean;
    double count = 0;
    for (const Spectrum& spectrum : spectra) {
        mean.power.resize(std::max(mean.power.size(), spectrum.power.size()), 0);
        for (size_t i = 0; i < spectrum.power.size(); i++)
            mean.power[i] += spectrum.power[i];
        mean.low += spectrum.low;
        mean.high += spectrum.high;
        count += spectrum.power.empty() ? 0 : 1;
    }
    for (double& power : mean.power)
        power /= count;
    mean.low /= std::max(count, 1.0);
    mean.high /= std::max(count, 1.0);
    return mean;
}

} // namespace vkpt::analysis
