// SPDX-License-Identifier: GPL-2.0-or-later
// What every light sampler shares. A sampler is one file shaders/light_samplers/NAME.glsl; NAME is the value of
// pt_light_sampler. The file includes this one and defines
//
//     LightSample sample_light(LightListView list, Surface s, float xi, uint subset_length)
//         Picks an emitter of the list for surface `s`. xi in [0, 1), uniform; subset_length >= 1: how many lights may be
//         weighed. Reports the exact probability of the pick. Nothing to pick: no_light().
//     float light_probability(LightListView list, Surface s, uint emitter, float xi, uint subset_length)
//         The probability with which sample_light picks `emitter` (0: never, or not in the list). Averaged over xi the
//         estimate f / probability must be unbiased; a sampler whose probability depends on random choices may use xi,
//         which is then the one given to sample_light.
//
// Lists are sorted ascending by emitter index and hold no emitter twice. light_contribution() is the weight to choose by.
// Files must compile as GLSL and as C++ (shared/functions.h); the tests check every file that the build finds.
#ifndef VKPT_LIB_LIGHT_SAMPLER
#define VKPT_LIB_LIGHT_SAMPLER

#include "bsdf.glsl"
#include "emitters.glsl"
#include "light_lists.glsl"

struct LightSample {
    int emitter; // index into the emitter table, -1: none
    float probability;
};

// Longer subsets than this are cut to it (weights are kept in an array).
const uint max_subset_length = 64u;
const float max_below_one = 0.99999994f; // 1 - 2^-24

LightSample no_light()
{
    LightSample result;
    result.emitter = -1;
    result.probability = 0.0f;
    return result;
}

LightSample make_light_sample(uint emitter, float probability)
{
    LightSample result;
    result.emitter = int(emitter);
    result.probability = probability;
    return result;
}

// floor(xi * count), safe against rounding up to count.
uint choose_uniformly(float xi, uint count)
{
    return min(uint(xi * float(count)), count - 1u);
}

#endif
