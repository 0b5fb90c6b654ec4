// SPDX-License-Identifier: GPL-2.0-or-later
// The rays that the tracing benches trace, and how they take time.
#pragma once

#include "common/quantile.hpp"
#include "tests/rays/scenes.hpp"
#include "tests/rays/trace_rays.h"

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace vkpt::tests {

// Tiles of 8 x 8 pixels in blocks of 4 x 4: the 16 lanes of a vector look in nearly one direction.
glm::uvec2 pixel_of(uint32_t index, uint32_t width);

// From the scene's eye, 90 degrees wide, in tile order; both sizes multiples of 8.
std::vector<shared::TestRay> camera_rays(const MapScene& scene, glm::uvec2 size);

struct RaySet {
    const char* name;
    bool any_hit;
    std::vector<shared::TestRay> rays;
    std::vector<uint32_t> places; // of each ray: its pixel's number in tile order
};

// The camera's rays, and from what each met one cosine-distributed bounce and one shadow ray to a light. Where a camera
// ray meets nothing, the other two sets have no ray.
std::vector<RaySet> make_ray_sets(
    const MapScene& scene, std::vector<shared::TestRay> camera, std::span<const shared::TestHit> hits);

// CPU time of the process, all threads, during `work`.
double cpu_seconds_of(const std::function<void()>& work);

} // namespace vkpt::tests
