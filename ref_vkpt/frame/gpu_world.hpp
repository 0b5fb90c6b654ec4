// SPDX-License-Identifier: GPL-2.0-or-later
// A map's data that does not change, on the device.
#pragma once

#include "ref_vkpt/frame/light_cache.hpp"
#include "ref_vkpt/lights/sampler_tables.hpp"
#include "ref_vkpt/scene/world.hpp"
#include "ref_vkpt/vulkan/uploader.hpp"
#include "shaders/shared/frame.h"

#include <cstdint>

namespace vkpt {

// Of the map's static lights. Large maps take a while; from any thread.
SamplerTables make_sampler_tables(const World& world, uint32_t needs);

struct GpuWorld {
    Buffer light_indices; // SamplerTables::indices
#define VKPT_SAMPLER_TABLE(name, type, alignment) Buffer name;
#include "shaders/shared/sampler_tables.def"
    uint32_t light_tree_lights = 0; // where their order begins in light_indices
    uint32_t sampler_needs = 0; // SamplerTables::needs
    Buffer bsp_tree;
    Buffer lightmap_faces, luxels; // not before pt_wipe asks for them
    GpuLightCache light_cache;
    Buffer light_visibility;
    uint64_t version = 0; // another for every map; 0: not uploaded yet

    shared::SamplerTableAddresses sampler_tables() const;
};
// Usable after uploader.flush().
GpuWorld upload_world(const World& world, const SamplerTables& tables, Uploader& uploader);
// The baked lightmaps. Usable after uploader.flush().
void upload_lightmaps(GpuWorld& gpu, const World& world, Uploader& uploader);
// In the place of those that are there; the device is idle. Usable after uploader.flush().
void upload_sampler_tables(GpuWorld& gpu, const SamplerTables& tables, Uploader& uploader);

} // namespace vkpt
