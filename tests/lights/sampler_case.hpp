// SPDX-License-Identifier: GPL-2.0-or-later
// The light samplers as C++: every file of shaders/light_samplers, compiled into a namespace of its own.
#pragma once

#include "ref_vkpt/lights/sampler_tables.hpp"
#include "shaders/shared/cvars.h"
#include "shaders/shared/functions.h"
#include "shaders/shared/light_sampler.h"
#include "shaders/shared/light_visibility.h"
#include "shaders/shared/ltc.h"
#include "shaders/shared/noise.h"
#include "shaders/shared/scene.h"

#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

namespace vkpt::test {

struct ShadingPoint {
    glm::vec3 position { 0 }, normal { 0, 0, 1 }, view { 0, 0, 1 }, albedo { 0.5f };
    float roughness = 0.5f, metallic = 0;
};

// A light list in memory, with the tables of samplers about its static part. Emitters that are not in it are part
// of the scene, too: BSDF rays may meet them.
struct ListCase {
    std::vector<shared::Emitter> emitters;
    std::vector<uint32_t> static_indices, dynamic_indices;
    std::vector<float> lightstyles = std::vector<float>(256, 1.0f);
    shared::LightList range {};
    SamplerTables tables;
    ShadingPoint point;

    // Whenever the static lights have changed. `multiset`: of the static indices, which hold it already.
    void make_tables(const shared::LightMultiset& multiset);

    bool contains(uint32_t emitter) const
    {
        for (size_t i = 0; i < light_count(); i++)
            if (light_at(i) == emitter)
                return true;
        return false;
    }
    size_t light_count() const { return range.static_count + range.dynamic_count; }
    uint32_t light_at(size_t i) const
    {
        return i < range.static_count ? static_indices[range.first_static + i]
                                      : dynamic_indices[range.first_dynamic + i - range.static_count];
    }
};

struct SamplerOptions {
    uint32_t subset_length = 8;
    int weight = shared::LIGHT_WEIGHT_BRDF_CENTRE;
    int point = shared::LIGHT_POINT_SOLID_ANGLE;
    glm::uvec4 hidden { 0 }; // what is believed of the lights' visibility, shared/light_visibility.h
};

// The random numbers of one choice.
struct Draw {
    float light = 0;
    glm::vec2 point { 0.5f };
    uint32_t stream = 0; // what the sampler draws beyond
};

float draw_unit(std::mt19937& rng); // as the shaders do: 24 bits
Draw make_draw(std::mt19937& rng);

struct PickedLight {
    int emitter;
    float probability;
    glm::vec2 point;
};

// The numbers of a pixel's path, as the shaders draw them.
struct PixelNumbers {
    glm::uvec2 pixel { 0 };
    uint32_t frame = 0, seed = 1;
    const uint32_t* masks = nullptr; // nullptr: white
};

struct BsdfNumbers {
    glm::vec2 direction;
    float lobe;
};

struct Sampler {
    const char* name;
    uint32_t traits; // SAMPLER_*
    PickedLight (*pick)(const ListCase& list, const Draw& draw, const SamplerOptions& options);
    float (*probability)(const ListCase& list, uint32_t emitter, const Draw& draw, const SamplerOptions& options);
    float (*contribution)(const ListCase& list, uint32_t emitter, const SamplerOptions& options);
    // One sample of the light (luminance) that all emitters, unshadowed, make the point reflect: the share found by
    // light sampling, and with mis that found by a BSDF ray, which passes through what it meets.
    double (*sample_lights)(const ListCase& list, const Draw& draw, const SamplerOptions& options);
    double (*sample_bsdf_ray)(
        const ListCase& list, const BsdfNumbers& numbers, const Draw& draw, const SamplerOptions& options);
    // Both together for a pixel.
    double (*light_pixel)(const ListCase& list, const PixelNumbers& numbers, const SamplerOptions& options);
    // The same by quadrature with n x n points on each emitter.
    double (*integrate)(const ListCase& list, int n);

    bool has(uint32_t trait) const { return (traits & trait) != 0; }
};

std::vector<Sampler>& all_samplers();
bool register_sampler(const Sampler& sampler);
const Sampler& find_sampler(std::string_view name); // throws: there is none

} // namespace vkpt::test
