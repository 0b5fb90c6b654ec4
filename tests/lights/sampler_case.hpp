// SPDX-License-Identifier: GPL-2.0-or-later
// The light samplers as C++: every file of shaders/light_samplers, compiled into a namespace of its own.
#pragma once

#include "shaders/shared/functions.h"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <vector>

namespace vkpt::test {

struct ShadingPoint {
    glm::vec3 position { 0 }, normal { 0, 0, 1 }, view { 0, 0, 1 }, albedo { 0.5f };
    float roughness = 0.5f, metallic = 0;
};

// A light list in memory.
struct ListCase {
    std::vector<shared::Emitter> emitters;
    std::vector<uint32_t> static_indices, dynamic_indices;
    std::vector<float> lightstyles = std::vector<float>(256, 1.0f);
    shared::LightList range {};
    ShadingPoint point;

    size_t light_count() const { return range.static_count + range.dynamic_count; }
    uint32_t light_at(size_t i) const
    {
        return i < range.static_count ? static_indices[range.first_static + i]
                                      : dynamic_indices[range.first_dynamic + i - range.static_count];
    }
};

struct PickedLight {
    int emitter;
    float probability;
};

struct Sampler {
    const char* name;
    PickedLight (*pick)(const ListCase& list, float xi, uint32_t subset_length);
    float (*probability)(const ListCase& list, uint32_t emitter, float xi, uint32_t subset_length);
    float (*contribution)(const ListCase& list, uint32_t emitter);
};

std::vector<Sampler>& all_samplers();
bool register_sampler(const Sampler& sampler);

} // namespace vkpt::test
