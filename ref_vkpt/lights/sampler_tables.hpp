// SPDX-License-Identifier: GPL-2.0-or-later
// What some light samplers read beside the light lists (shaders/shared/sampler_tables.def).
#pragma once

#include "ref_vkpt/lights/face_triangles.hpp"
#include "ref_vkpt/lights/light_lists.hpp"
#include "shaders/shared/light_sampler.h"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vkpt {

// The static lights that tables are made of.
struct SamplerTableSource {
    std::span<const shared::LightList> lists;
    std::span<const uint32_t> static_indices;
    std::span<const shared::Emitter> emitters;
    // nullptr: lists without a map. Then no table is made that has to know where clusters are.
    const formats::Bsp* bsp = nullptr;
    const LightLists* light_lists = nullptr;
    const FaceTriangles* faces = nullptr;
};

namespace sampler_table_rows {
using namespace shared; // for the rows' types
struct SamplerTables {
    uint32_t needs = 0; // SAMPLER_NEEDS_*: those that were made
    std::vector<uint32_t> indices; // the static indices; behind them what tables have as runs of lights
    uint32_t tree_lights = 0; // see LightTables
#define VKPT_SAMPLER_TABLE(name, type, alignment) std::vector<type> name;
#include "shaders/shared/sampler_tables.def"
};
} // namespace sampler_table_rows
using sampler_table_rows::SamplerTables;
// Large maps take a while; from any thread.
SamplerTables make_sampler_tables(const SamplerTableSource& source, uint32_t needs);

// Those of the rows, each in the file of its tables: fills them.
#define VKPT_SAMPLER_NEED(trait, bit, make) void make(const SamplerTableSource& source, SamplerTables& tables);
#include "shaders/shared/sampler_tables.def"

} // namespace vkpt
