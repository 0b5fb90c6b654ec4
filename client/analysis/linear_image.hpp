// SPDX-License-Identifier: GPL-2.0-or-later
// A picture as linear light, and the files that it is read from.
#pragma once

#include "common/colour.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace vkpt::analysis {

// Linear RGB with the primaries of sRGB, row by row from the top left.
struct LinearImage {
    int width = 0, height = 0;
    std::vector<float> rgb; // 3 * width * height
    // Read from an 8-bit file: display light 0..1, after somebody's exposure and tone mapping.
    bool is_display = false;

    size_t pixel_count() const { return size_t(width) * size_t(height); }
};
LinearImage make_image(int width, int height);

std::vector<float> luminances(const LinearImage& image);
double mean_luminance(const LinearImage& image);

// Adds `image` to `sum`, which may be empty. Throws std::invalid_argument where the sizes differ.
void add_image(LinearImage& sum, const LinearImage& image);
void scale_image(LinearImage& image, float factor);

// PNG (decoded by the sRGB curve), PFM or EXR (channels R, G, B), by the ending. Throws client::Failure naming file and
// remedy.
LinearImage read_image(const std::filesystem::path& path);

} // namespace vkpt::analysis
