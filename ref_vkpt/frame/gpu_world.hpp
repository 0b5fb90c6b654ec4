// SPDX-License-Identifier: GPL-2.0-or-later
// A map's data that does not change, on the device.
#pragma once

#include "ref_vkpt/frame/light_cache.hpp"
#include "ref_vkpt/lights/light_multisets.hpp"
#include "ref_vkpt/lights/light_trees.hpp"
#include "ref_vkpt/scene/world.hpp"
#include "ref_vkpt/vulkan/uploader.hpp"

#include <optional>

namespace vkpt {

// What some light samplers read beside the light lists, of the map's static lights.
struct SamplerTables {
    uint32_t needs = 0; // SAMPLER_NEEDS_*: those that were made
    std::optional<LightMultisets> multisets;
    std::optional<LightTrees> trees;
};
// Large maps take a while; from any thread.
SamplerTables make_sampler_tables(const World& world, uint32_t needs);

struct GpuWorld {
    Buffer light_indices, light_multisets, light_trees, light_tree_roots, light_tree_places;
    uint32_t light_tree_lights = 0; // where their order begins in light_indices
    uint32_t sampler_needs = 0; // SamplerTables::needs
    Buffer bsp_tree;
    GpuLightCache light_cache;
    uint64_t version = 0; // another for every map; 0: not uploaded yet
};
// Usable after uploader.flush().
GpuWorld upload_world(const World& world, const SamplerTables& tables, Uploader& uploader);
// In the place of those that are there; the device is idle. Usable after uploader.flush().
void upload_sampler_tables(GpuWorld& gpu, const World& world, const SamplerTables& tables, Uploader& uploader);

} // namespace vkpt
