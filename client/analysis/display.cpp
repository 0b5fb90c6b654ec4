// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/analysis/display.hpp"

#include "common/colour.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace vkpt::analysis {

namespace {

constexpr float middle_grey = 0.18f, white_luminance = 4; // of exposed light; what is brighter is white

uint8_t to_byte(float value) { return uint8_t(std::lround(255 * std::clamp(value, 0.0f, 1.0f))); }

formats::Rgba8 heat_colour(float value)
{
    constexpr float colours[][3]
        = { { 0, 0, 0 }, { .24f, .04f, .38f }, { .65f, .12f, .38f }, { .96f, .48f, .12f }, { .99f, .98f, .75f } };
    const float place = std::clamp(value, 0.0f, 1.0f) * float(std::size(colours) - 1);
    const size_t below = std::min(size_t(place), std::size(colours) - 2);
    const float share = place - float(below);
    const auto channel
        = [&](size_t c) { return to_byte(colours[below][c] + (colours[below + 1][c] - colours[below][c]) * share); };
    return { channel(0), channel(1), channel(2), 255 };
}

} // namespace

float choose_exposure(const LinearImage& image)
{
    const double mean = mean_luminance(image);
    if (image.is_display || !(mean > 0))
        return 1;
    // Black pixels must not pull the logarithm down without end.
    const double floor = 1e-3 * mean;
    double logs = 0;
    for (const float value : luminances(image))
        logs += std::log(std::max(double(value), 0.0) + floor);
    return float(double(middle_grey) / std::exp(logs / double(image.pixel_count())));
}

LinearImage map_to_display(const LinearImage& image, float exposure)
{
    LinearImage result = image;
    result.is_display = true;
    if (image.is_display)
        return result;
    for (size_t i = 0; i < image.pixel_count(); i++) {
        float* pixel = &result.rgb[3 * i];
        for (size_t c = 0; c < 3; c++)
            pixel[c] = std::max(pixel[c], 0.0f) * exposure;
        const float light = luminance(pixel);
        const float factor = (1 + light / (white_luminance * white_luminance)) / (1 + light);
        for (size_t c = 0; c < 3; c++)
            pixel[c] = std::min(pixel[c] * factor, 1.0f);
    }
    return result;
}

formats::Image encode_display(const LinearImage& display)
{
    formats::Image picture { display.width, display.height, std::vector<formats::Rgba8>(display.pixel_count()) };
    for (size_t i = 0; i < display.pixel_count(); i++) {
        const float* rgb = &display.rgb[3 * i];
        const auto channel = [&](size_t c) { return to_byte(encode_srgb(std::clamp(rgb[c], 0.0f, 1.0f))); };
        picture.pixels[i] = { channel(0), channel(1), channel(2), 255 };
    }
    return picture;
}

formats::Image draw_heat_map(const std::vector<float>& values, int width, int height)
{
    formats::Image picture { width, height, std::vector<formats::Rgba8>(values.size()) };
    std::ranges::transform(values, picture.pixels.begin(), heat_colour);
    return picture;
}

} // namespace vkpt::analysis
