// SPDX-License-Identifier: GPL-2.0-or-later
// Runs trace_rays.comp, the software backend's traversal, over a list of rays.
#pragma once

#include "ref_vkpt/rays/bvh.hpp"
#include "tests/rays/headless_compute.hpp"
#include "tests/rays/trace_rays.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vkpt::tests {

// [0] nearest hit, [1] any hit.
using TracePipelines = std::array<HeadlessCompute::Pipeline, 2>;
// Trees read by texels, or by address.
TracePipelines create_trace_pipelines(HeadlessCompute& device, bool by_texels = true);

// One tree or two, and rays, uploaded. Searches both trees as one.
class GpuTracer {
public:
    GpuTracer(
        HeadlessCompute& device, std::span<const Bvh> trees, std::span<const shared::TestRay> rays, uint32_t ray_mask);
    // Seconds from submission to completion.
    double run(const HeadlessCompute::Pipeline& pipeline);
    // Of the latest run.
    std::vector<shared::TestHit> hits() const;

private:
    HeadlessCompute& device_;
    HeadlessCompute::Buffer hits_, nodes_, triangles_;
    shared::TraceRaysPush push_ {};
    uint32_t groups_;
};

} // namespace vkpt::tests
