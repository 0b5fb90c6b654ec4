// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/trace/gpu_tracer.hpp"

#include "ref_vkpt/trace/wide_tree.hpp"
#include "shaders/shared/trace.h"

#include "trace_rays_spirv.h"

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
    std::vector<uint32_t> nodes, triangles;
    for (const Bvh& tree : trees) {
        nodes.insert(nodes.end(), tree.nodes.begin(), tree.nodes.end());
        triangles.insert(triangles.end(), tree.triangles.begin(), tree.triangles.end());
    }
    nodes_ = device.create_buffer_of(std::span<const uint32_t>(nodes));
    triangles_ = device.create_buffer_of(std::span<const uint32_t>(triangles));
    std::vector<BvhView> views;
    uint32_t first_node = 0, first_triangle = 0;
    for (const Bvh& tree : trees) {
        views.push_back({ nodes_.address + uint64_t(first_node) * BVH_NODE_BYTES,
            triangles_.address + uint64_t(first_triangle) * BVH_TRIANGLE_BYTES, first_node, first_triangle,
            tree.grid_origin, tree.grid_scale });
        first_node += uint32_t(tree.nodes.size() / bvh_node_words);
        first_triangle += uint32_t(tree.triangles.size() / bvh_triangle_words);
    }
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
