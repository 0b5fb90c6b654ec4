// SPDX-License-Identifier: GPL-2.0-or-later
// What the device found, against double precision on the CPU.
#pragma once

#include "ref_vkpt/rays/bvh.hpp"
#include "tests/rays/trace_rays.h"

#include <cstdint>
#include <span>

namespace vkpt::tests {

inline constexpr uint32_t all_rays = 0xff;

// Compares with the reference; ids must be indices into `triangles`. Whatever differs must be a close call, or a tie of
// two triangles at one distance, such as faces that maps have twice.
void expect_nearest_hits(std::span<const BvhTriangle> triangles, std::span<const shared::TestRay> rays,
    std::span<const shared::TestHit> hits, uint32_t ray_mask);
// The same for whether anything was met.
void expect_visibility(std::span<const BvhTriangle> triangles, std::span<const shared::TestRay> rays,
    std::span<const shared::TestHit> hits, uint32_t ray_mask);

} // namespace vkpt::tests
