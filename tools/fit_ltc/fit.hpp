// SPDX-License-Identifier: GPL-2.0-or-later
// Fits linearly transformed cosines (Heitz et al. 2016) to the specular lobe of shaders/lib/bsdf.glsl.
// Frame: z the surface's normal, the view in the xz plane.
#pragma once

#include <array>
#include <vector>

namespace vkpt::ltc {

// The layout of one table entry, see shaders/shared/ltc.h.
struct Entry {
    double xx, xz, yy, zx; // of the inverse matrix, zz = 1
    double albedo, grazing;
    double error; // of the fit: the mean of (lobe - fit)^2 / (lobe + fit) over the sphere, both normalised: 0 equal, 2
                  // apart
};

Entry fit_lobe(double roughness, double view_cosine);

// size x size entries as the table orders them.
std::vector<Entry> fit_table();

} // namespace vkpt::ltc
