// SPDX-License-Identifier: GPL-2.0-or-later
// Listing 47-1: a strided subset of the list, then a light of it by predicted contribution, in two sweeps with one
// random number. Each light owns one interval of that number, so that blue noise in it stays blue in the image.
#ifndef VKPT_LIGHT_SAMPLER_SUBSET
#define VKPT_LIGHT_SAMPLER_SUBSET

#include "../lib/light_subsets.glsl"

const uint light_sampler_traits = SAMPLER_USES_SUBSET;

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    return sample_strided_subset(list, s, random, options);
}

float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    return strided_subset_probability(list, make_predictor(s, options), emitter, options.subset_length);
}

#endif
