// SPDX-License-Identifier: GPL-2.0-or-later
// Path-traced light at luxels, measured through the refresh module.
#pragma once

#include "tools/calibrate_light/fit.hpp"
#include "tools/calibrate_light/luxels.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace vkpt::tools {

struct MeasureOptions {
    std::string module, base_folder, game;
    size_t luxels = 2000; // per map
    uint32_t samples = 64; // paths per luxel
    int bounces = 4;
    uint32_t seed = 1;
    bool verbose = false;
};

// Throws formats::FormatError, client::Failure.
MapComparison compare_map(const std::filesystem::path& file, const MeasureOptions& options);

} // namespace vkpt::tools
