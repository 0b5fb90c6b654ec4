// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/gpu_world.hpp"

#include "ref_vkpt/frame/light_visibility.hpp"
#include "ref_vkpt/scene/lightmaps.hpp"

namespace vkpt {

SamplerTables make_sampler_tables(const World& world, uint32_t needs)
{
    const LightLists& lists = world.light_lists;
    return make_sampler_tables(
        { lists.lists(), lists.static_indices(), world.models[0].emitters, &world.bsp, &lists, &world.faces }, needs);
}

shared::SamplerTableAddresses GpuWorld::sampler_tables() const
{
    return {
#define VKPT_SAMPLER_TABLE(name, type, alignment) name.address(),
#include "shaders/shared/sampler_tables.def"
    };
}

GpuWorld upload_world(const World& world, const SamplerTables& tables, Uploader& uploader)
{
    static uint64_t versions = 0;
    GpuWorld gpu;
    upload_sampler_tables(gpu, tables, uploader);
    gpu.bsp_tree = uploader.make_buffer(world.light_lists.tree(), MemoryKind::geometry, "BSP tree");
    gpu.light_cache = upload_light_cache(world.light_cache, uploader);
    gpu.light_visibility = make_light_visibility(uploader);
    gpu.version = ++versions;
    return gpu;
}

void upload_lightmaps(GpuWorld& gpu, const World& world, Uploader& uploader)
{
    const Lightmaps maps = read_lightmaps(world);
    gpu.lightmap_faces = uploader.make_buffer(maps.faces, MemoryKind::lights, "lightmap faces");
    gpu.luxels = uploader.make_buffer(maps.luxels, MemoryKind::lights, "luxels");
}

void upload_sampler_tables(GpuWorld& gpu, const SamplerTables& tables, Uploader& uploader)
{
    gpu.sampler_needs = tables.needs;
    gpu.light_tree_lights = tables.tree_lights;
#define VKPT_SAMPLER_TABLE(name, type, alignment)                                                                      \
    gpu.name = Buffer();                                                                                               \
    if (!tables.name.empty())                                                                                          \
        gpu.name = uploader.make_buffer(tables.name, MemoryKind::lights, "light " #name);
#include "shaders/shared/sampler_tables.def"
    gpu.light_indices = uploader.make_buffer(tables.indices, MemoryKind::lights, "light lists");
}

} // namespace vkpt
