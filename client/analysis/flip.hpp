// SPDX-License-Identifier: GPL-2.0-or-later
// The difference that a viewer sees who flips between two pictures: a reimplementation of the formulas of Andersson et
// al. 2020, "FLIP: A Difference Evaluator for Alternating Images", for pictures in display light. Colours pass the
// eye's contrast sensitivity (spatial CIELAB) and are compared by HyAB; edges and points that one picture lacks raise
// the difference.
#pragma once

#include "client/analysis/linear_image.hpp"

#include <vector>

namespace vkpt::analysis {

// The paper's: 70 cm before a screen 70 cm wide with 3840 pixels.
inline constexpr double default_pixels_per_degree = 67.0206;

// Per pixel 0 (equal) to 1. Both in display light (LinearImage::is_display); throws std::invalid_argument where the
// sizes differ.
std::vector<float> measure_flip(
    const LinearImage& reference, const LinearImage& image, double pixels_per_degree = default_pixels_per_degree);
double mean_flip(const std::vector<float>& map);

} // namespace vkpt::analysis
