// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a device's pictures look as they ought to: brightness in a coarse grid, compared with what Mesa's CPU driver
// showed.
#pragma once

#include "formats/image.hpp"

#include <string_view>
#include <vector>

namespace vkpt::client {

inline constexpr int grid_columns = 16, grid_rows = 9;

// Mean luminance of each part of the picture, sRGB-encoded, 0..255, row by row.
std::vector<float> measure_grid(const formats::Image& picture);

struct GridDifference {
    double mean = 0, max = 0; // of the parts' absolute differences
    bool is_small() const { return mean <= max_mean && max <= max_max; }

    // On the CPU driver, other ways to trace change .15 and .3, other random numbers .35 and 4.2.
    static constexpr double max_mean = 1, max_max = 8;
};
// Both have as many parts, at least one.
GridDifference compare_grids(const std::vector<float>& expected, const std::vector<float>& found);

// A place in our map, and what is expected there. Empty expected: none is known.
struct CheckedView {
    std::string_view name, scene; // SCENE of the command line
    std::vector<float> expected;
};
std::vector<CheckedView> list_checked_views();

} // namespace vkpt::client
