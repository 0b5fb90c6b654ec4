// SPDX-License-Identifier: GPL-2.0-or-later
// Listing 47-3: pseudo-marginal MIS. Subsets as in `subset_strides`; an emitter that a BSDF ray met takes the place of
// its stride's light, which gives the probability (equation 47.20) for the balance heuristic.
#ifndef VKPT_LIGHT_SAMPLER_SUBSET_MIS
#define VKPT_LIGHT_SAMPLER_SUBSET_MIS

#include "../lib/light_subsets.glsl"

const uint light_sampler_traits = SAMPLER_MIS | SAMPLER_USES_SUBSET;

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    return sample_independent_strides(list, make_predictor(s, options), random, options.subset_length);
}

float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    return independent_strides_probability(list, make_predictor(s, options), emitter, random, options.subset_length);
}

#endif
