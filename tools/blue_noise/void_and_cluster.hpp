// SPDX-License-Identifier: GPL-2.0-or-later
// Spatiotemporal blue-noise masks by void and cluster (Ulichney 1993), with the energy of Wolfe et al., "Spatiotemporal
// Blue Noise Masks", EGSR 2022: a 2D Gaussian among voxels of one slice, a 1D Gaussian along time at one pixel, nothing
// between voxels that share neither. All distances are toroidal.
#pragma once

#include <cstdint>
#include <vector>

namespace vkpt::blue_noise {

struct MaskShape {
    int size = 64; // pixels across and down a slice; a power of two
    int slices = 16; // a power of two
};

struct MaskSettings {
    MaskShape shape;
    double spatial_sigma = 1.9; // pixels
    double temporal_sigma = 1.9; // slices
    uint32_t seed = 1;
};

// The mask's values, slice by slice, row by row: rank * slices + order, where the ranks of one slice are a permutation
// of 0 .. size^2 - 1 and the voxels of equal rank share the orders 0 .. slices - 1. So every value of 0 .. voxels - 1
// appears once, and every slice is uniform by itself. The same settings give the same mask on every machine: the energy
// is integer.
std::vector<uint32_t> make_mask(const MaskSettings& settings);

} // namespace vkpt::blue_noise
