// SPDX-License-Identifier: GPL-2.0-or-later
// A path tracer in double precision for checking the module: no light lists, no subsets, no filters. Every light of the
// scene is weighed at every surface. Slow.
#pragma once

#include "tests/truth/exported_scene.hpp"

#include <cstdint>

namespace vkpt::truth {

struct TraceSettings {
    int bounces = 1; // as pt_bounces
    int samples_per_pixel = 64;
    uint64_t seed = 1;
};

// Radiance of each pixel, row by row from the top left, by the scene's camera. Unlike the module's, its rays meet
// neither water nor glass: throws std::runtime_error where a camera ray does.
std::vector<dvec3> render(const ExportedScene& scene, const TraceSettings& settings);

} // namespace vkpt::truth
