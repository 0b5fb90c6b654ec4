// SPDX-License-Identifier: GPL-2.0-or-later
// What can be said about a rendered picture without another picture to compare it with.
#pragma once

#include "formats/image.hpp"

#include <filesystem>
#include <vector>

namespace vkpt::tests {

struct PictureStatistics {
    double mean = 0; // of luminance, sRGB-encoded, 0..1
    double deviation = 0; // of luminance: structure and noise together
    double noise = 0; // standard deviation of the noise, 0..1
    double black = 0; // fraction of pixels that are exactly black
};

// Noise is estimated after Immerkaer, "Fast Noise Variance Estimation" (1996): the mean absolute answer of a filter
// that cancels constant and linear signals, so that walls and their shading do not count, only what varies pixel by
// pixel.
PictureStatistics measure_picture(const formats::Image& picture);

formats::Image load_picture(const std::filesystem::path& path);

// The PNG files of a folder by name; empty where there is no such folder.
std::vector<std::filesystem::path> list_pictures(const std::filesystem::path& folder);

} // namespace vkpt::tests
