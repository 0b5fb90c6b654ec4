// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/trace/gpu_tracer.hpp"

#include "shaders/shared/trace.h"

#include "trace_rays_spirv.h"

#include <cstring>

namespace vkpt::tests {

using namespace shared;

std::array<HeadlessCompute::Pipeline, 2> create_trace_pipelines(HeadlessCompute& device)
{
    auto create = [&](uint32_t any_hit) {
        return device.create_pipeline(trace_rays_spirv, sizeof(TraceRaysPush), std::span(&any_hit, 1));
    };
    return { create(0), create(1) };
}

GpuTracer::GpuTracer(
    HeadlessCompute& device, std::span<const Bvh> trees, std::span<const TestRay> rays, uint32_t ray_mask)
    : device_(device)
    , hits_(device.create_buffer(rays.size() * sizeof(TestHit)))
    , groups_((uint32_t(rays.size()) + TRACE_RAYS_PER_GROUP - 1) / TRACE_RAYS_PER_GROUP)
{
    std::vector<BvhView> views;
    for (const Bvh& tree : trees)
        views.push_back({ device.create_buffer_of(std::span<const uint32_t>(tree.nodes)).address,
            device.create_buffer_of(std::span<const uint32_t>(tree.triangles)).address, tree.grid_origin,
            tree.grid_scale });
    push_.rays = device.create_buffer_of(rays).address;
    push_.hits = hits_.address;
    if (!views.empty()) {
        push_.first_tree = views[0];
        push_.more_trees = device.create_buffer_of(std::span<const BvhView>(views).subspan(1)).address;
    }
    push_.stack = device.create_buffer(size_t(groups_) * TRACE_RAYS_GROUP * TRACE_STACK_BYTES_PER_LANE).address;
    push_.ray_count = uint32_t(rays.size());
    push_.tree_count = uint32_t(views.size());
    push_.ray_mask = ray_mask;
}

double GpuTracer::run(const HeadlessCompute::Pipeline& pipeline) { return device_.dispatch(pipeline, &push_, groups_); }

std::vector<TestHit> GpuTracer::hits() const
{
    std::vector<TestHit> hits(push_.ray_count);
    std::memcpy(static_cast<void*>(hits.data()), hits_.mapped, hits.size() * sizeof(TestHit));
    return hits;
}

} // namespace vkpt::tests
