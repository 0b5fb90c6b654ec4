// SPDX-License-Identifier: GPL-2.0-or-later
// Which light sampler the next frames use: that of pt_light_sampler, once the device has the tables that it reads. They
// are made on a thread of their own, while frames go on with the sampler before.
#pragma once

#include "ref_vkpt/frame/gpu_world.hpp"
#include "ref_vkpt/vulkan/shaders.hpp"

#include <cstdint>
#include <functional>
#include <future>

namespace vkpt {

class SamplerChoice {
public:
    // SAMPLER_NEEDS_* of pt_light_sampler and of the light cache, for a map that is loaded.
    static uint32_t wanted_needs();
    // Before the map goes.
    void forget_world();
    // `upload` brings tables to the device. `waits`: frames are to have the wanted sampler whatever that takes.
    const LightSampler& choose(const World* world, const GpuWorld& gpu_world, bool waits,
        const std::function<void(const SamplerTables&)>& upload);

private:
    const LightSampler* chosen_ = nullptr;
    std::future<SamplerTables> tables_; // that are being made
    uint32_t needs_ = 0; // of tables_
};

} // namespace vkpt
