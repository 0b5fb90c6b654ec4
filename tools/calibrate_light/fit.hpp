// SPDX-License-Identifier: GPL-2.0-or-later
// Statistics of path-traced against baked light, and the scales that bring them together.
#pragma once

#include "tools/calibrate_light/variants.hpp"

#include <array>
#include <string>
#include <vector>

namespace vkpt::tools {

using Scales = std::array<double, light_kind_count>; // by LightKind

// One luxel: what each kind of light gives with the present scales, and what the lightmap says. Luminances.
struct Comparison {
    Scales traced {};
    double baked = 0;

    double traced_with(const Scales& factors) const;
};

struct MapComparison {
    std::string name;
    std::vector<Comparison> luxels;
};

struct Quartiles {
    double lower = 0, median = 0, upper = 0;
};

// Of traced / baked. All 0 for no luxels.
Quartiles measure_ratio(const MapComparison& map, const Scales& factors);

// The factors to the present scales that make |log of the maps' median ratios| least in sum, and among those the ratios
// spread least. A kind of light that no map has keeps 1.
Scales fit_factors(const std::vector<MapComparison>& maps);

} // namespace vkpt::tools
