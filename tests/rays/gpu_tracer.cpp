// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/rays/gpu_tracer.hpp"

#include "ref_vkpt/rays/wide_tree.hpp"
#include "shaders/shared/trace.h"

#include "trace_rays_spirv.h"

#include <cassert>
#include <cstring>

namespace vkpt::tests {

using namespace shared;

TracePipelines create_trace_pipelines(HeadlessCompute& device, bool by_texels)
{
    auto create = [&](uint32_t any_hit) {
        const uint32_t constants[] = { any_hit, by_texels };
        constexpr VkDescriptorType trees[]
            = { VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER };
        return device.create_pipeline(trace_rays_spirv, sizeof(TraceRaysPush), constants, trees);
    };
    return { create(0), create(1) };
}

GpuTracer::GpuTracer(
    HeadlessCompute& device, std::span<const Bvh> trees, std::span<const TestRay> rays, uint32_t ray_mask)
    : device_(device)
    , hits_(device.create_buffer(rays.size() * sizeof(TestHit)))
    , groups_((uint32_t(rays.size()) + TRACE_RAYS_PER_GROUP - 1) / TRACE_RAYS_PER_GROUP)
{
    assert(trees.size() == 1 || trees.size() == 2);
    std::vector<uint32_t> nodes, triangles;
    uint32_t roots[2] = { BVH_NO_CHILD, BVH_NO_CHILD };
    for (size_t i = 0; i < trees.size(); i++) {
        const TreePlace place { uint32_t(nodes.size() / bvh_node_words),
            uint32_t(triangles.size() / bvh_triangle_words) };
        nodes.insert(nodes.end(), trees[i].nodes.begin(), trees[i].nodes.end());
        place_nodes(std::span(nodes).last(trees[i].nodes.size()), place);
        triangles.insert(triangles.end(), trees[i].triangles.begin(), trees[i].triangles.end());
        roots[i] = place.first_node;
    }
    nodes_ = device.create_buffer_of(std::span<const uint32_t>(nodes));
    triangles_ = device.create_buffer_of(std::span<const uint32_t>(triangles));
    push_.trees = { nodes_.address, triangles_.address, roots[0], roots[1] };
    push_.rays = device.create_buffer_of(rays).address;
    push_.hits = hits_.address;
    push_.stack = device.create_buffer(size_t(groups_) * TRACE_RAYS_GROUP * TRACE_STACK_BYTES_PER_LANE).address;
    push_.ray_count = uint32_t(rays.size());
    push_.ray_mask = ray_mask;
}

double GpuTracer::run(const HeadlessCompute::Pipeline& pipeline)
{
    const HeadlessCompute::Binding bindings[] = { { .texels = nodes_.buffer, .format = VK_FORMAT_R32G32B32A32_UINT },
        { .texels = triangles_.buffer, .format = VK_FORMAT_R32G32B32A32_UINT } };
    device_.bind(pipeline, bindings);
    return device_.dispatch(pipeline, &push_, groups_);
}

std::vector<TestHit> GpuTracer::hits() const
{
    std::vector<TestHit> hits(push_.ray_count);
    std::memcpy(static_cast<void*>(hits.data()), hits_.mapped, hits.size() * sizeof(TestHit));
    return hits;
}

} // namespace vkpt::tests
