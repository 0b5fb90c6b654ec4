// SPDX-License-Identifier: GPL-2.0-or-later
// From linear light to what a screen shows, the same way for all pictures of a comparison.
#pragma once

#include "client/analysis/linear_image.hpp"
#include "formats/image.hpp"

namespace vkpt::analysis {

// The transfer curve of IEC 61966-2-1; both ways 0..1.

// The factor that brings a picture's log-average luminance to middle grey, .18 (Reinhard et al. 2002, "Photographic
// Tone Reproduction for Digital Images", equations 1 and 2). 1 for display pictures and black ones.
float choose_exposure(const LinearImage& image);

// Exposed light to display light 0..1: the same paper's equation 4 on luminance, where 4 and
// more is white; saturated colours are clipped. Display pictures stay as they are.
LinearImage map_to_display(const LinearImage& image, float exposure);
// Display light to 8 bits.
formats::Image encode_display(const LinearImage& display);

// Values 0..1 from black over violet and orange to pale yellow, of growing luminance.
formats::Image draw_heat_map(const std::vector<float>& values, int width, int height);

} // namespace vkpt::analysis
