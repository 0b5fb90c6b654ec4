// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "tools/map_compiler/brushes.hpp"

namespace vkpt::tools {

// Bakes the lightmaps of a compiled map: fills `lighting` and the faces' styles and offsets.
void light_map(formats::Bsp& bsp, const SourceMap& world, unsigned threads, const WarningSink& progress);

} // namespace vkpt::tools
