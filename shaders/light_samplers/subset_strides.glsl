// SPDX-License-Identifier: GPL-2.0-or-later
// Equation 47.19: the subset takes a light of its own choice from each stride. Without MIS this only costs
// stratification; it is here to be compared with `subset` and with `subset_mis`.
#ifndef VKPT_LIGHT_SAMPLER_SUBSET_STRIDES
#define VKPT_LIGHT_SAMPLER_SUBSET_STRIDES

#include "../lib/light_subsets.glsl"

const uint light_sampler_traits = SAMPLER_USES_SUBSET;

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    return sample_independent_strides(list, make_predictor(s, options), random, options.subset_length);
}

float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    return independent_strides_probability(list, make_predictor(s, options), emitter, random, options.subset_length);
}

#endif
