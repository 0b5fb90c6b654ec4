// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/gpu_world.hpp"

#include "shaders/shared/light_sampler.h"

namespace vkpt {

SamplerTables make_sampler_tables(const World& world, uint32_t needs)
{
    const LightLists& lists = world.light_lists;
    const std::vector<shared::Emitter>& emitters = world.models[0].emitters;
    SamplerTables tables { needs & shared::SAMPLER_NEEDS, {}, {} };
    if (needs & shared::SAMPLER_NEEDS_MULTISETS)
        tables.multisets = make_light_multisets(world.bsp, lists, emitters);
    if (needs & shared::SAMPLER_NEEDS_TREES)
        tables.trees = make_light_trees(lists.lists(), lists.static_indices(), emitters);
    return tables;
}

GpuWorld upload_world(const World& world, const SamplerTables& tables, Uploader& uploader)
{
    static uint64_t versions = 0;
    GpuWorld gpu;
    upload_sampler_tables(gpu, world, tables, uploader);
    gpu.bsp_tree = uploader.make_buffer(world.light_lists.tree(), MemoryKind::geometry, "BSP tree");
    gpu.light_cache = upload_light_cache(world.light_cache, uploader);
    gpu.version = ++versions;
    return gpu;
}

// The lists' static indices, then the multisets' entries and the trees' lights: all are read as runs of one table.
void upload_sampler_tables(GpuWorld& gpu, const World& world, const SamplerTables& tables, Uploader& uploader)
{
    gpu.sampler_needs = tables.needs;
    for (Buffer* buffer : { &gpu.light_multisets, &gpu.light_trees, &gpu.light_tree_roots, &gpu.light_tree_places })
        *buffer = Buffer();
    std::vector<uint32_t> indices = tables.multisets ? tables.multisets->entries : world.light_lists.static_indices();
    if (tables.multisets)
        gpu.light_multisets = uploader.make_buffer(tables.multisets->ranges, MemoryKind::lights, "light multisets");
    if (tables.trees) {
        const LightTrees& trees = *tables.trees;
        gpu.light_tree_lights = uint32_t(indices.size());
        indices.insert(indices.end(), trees.lights.begin(), trees.lights.end());
        gpu.light_tree_roots = uploader.make_buffer(trees.roots, MemoryKind::lights, "light tree roots");
        gpu.light_tree_places = uploader.make_buffer(trees.places, MemoryKind::lights, "light tree places");
        gpu.light_trees = uploader.make_buffer(trees.nodes, MemoryKind::lights, "light trees");
    }
    gpu.light_indices = uploader.make_buffer(indices, MemoryKind::lights, "light lists");
}

} // namespace vkpt
