// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/frame/sampler_choice.hpp"

#include "ref_vkpt/cvars.hpp"
#include "ref_vkpt/cvars_rows.hpp"
#include "ref_vkpt/frame/light_cache.hpp"
#include "shaders/shared/light_sampler.h"

#include <chrono>

namespace vkpt {

namespace {

const LightSampler& wanted_sampler()
{
    const LightSampler* const sampler = find_light_sampler(cvars::values().pt_light_sampler);
    if (sampler)
        return *sampler;
    return *find_light_sampler(find_cvar_row("pt_light_sampler")->initial); // until it is put right
}

bool is_ready(const std::future<SamplerTables>& tables)
{
    return tables.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

} // namespace

uint32_t SamplerChoice::wanted_needs()
{
    return (wanted_sampler().traits & shared::SAMPLER_NEEDS) | light_cache_needs();
}

void SamplerChoice::forget_world()
{
    tables_ = {}; // waits
    chosen_ = nullptr;
}

const LightSampler& SamplerChoice::choose(
    const World* world, const GpuWorld& gpu_world, bool waits, const std::function<void(const SamplerTables&)>& upload)
{
    const LightSampler& wanted = wanted_sampler();
    const uint32_t missing = wanted_needs() & ~gpu_world.sampler_needs;
    if (!world || gpu_world.version == 0 || missing == 0)
        return *(chosen_ = &wanted);
    if (!tables_.valid() || (missing & ~needs_)) {
        needs_ = missing | gpu_world.sampler_needs;
        tables_
            = std::async(std::launch::async, [world, needs = needs_] { return make_sampler_tables(*world, needs); });
    }
    if (waits || !chosen_ || is_ready(tables_)) {
        upload(tables_.get());
        chosen_ = &wanted;
    }
    return *chosen_;
}

} // namespace vkpt
