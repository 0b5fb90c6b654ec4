// SPDX-License-Identifier: GPL-2.0-or-later
// Listing 47-2: the probabilities of `subset` in one sweep and without an array. A reservoir keeps one light; the
// random number is stretched at each decision. A light's share of it is then many intervals: blue noise in it counts
// for less.
#ifndef VKPT_LIGHT_SAMPLER_SUBSET_ONESWEEP
#define VKPT_LIGHT_SAMPLER_SUBSET_ONESWEEP

#include "../lib/light_subsets.glsl"

const uint light_sampler_traits = SAMPLER_USES_SUBSET;

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    if (light_count(list) == 0u)
        return no_light();
    SubsetChoice choice = choose_subset(list, random.light, options.subset_length);
    Reservoir reservoir = sweep_subset(list, make_predictor(s, options), choice, choice.rest);
    return make_subset_sample(reservoir, choice.stride, random);
}

float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    return strided_subset_probability(list, make_predictor(s, options), emitter, options.subset_length);
}

#endif
