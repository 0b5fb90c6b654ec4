// SPDX-License-Identifier: GPL-2.0-or-later
// `subset` with a subset of its own for the dynamic lights: muzzle flashes, projectiles, explosions, whatever moves.
// They are few and often outshine all others, but a subset of the whole list holds a given one only once in S times.
// Here, as long as they are no more than R, each is weighed every time. Without dynamic lights this is `subset` to the
// last bit.
#ifndef VKPT_LIGHT_SAMPLER_SUBSET_DYNAMIC
#define VKPT_LIGHT_SAMPLER_SUBSET_DYNAMIC

#include "../lib/light_subsets.glsl"

const uint light_sampler_traits = SAMPLER_USES_SUBSET;

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    return sample_subsets_of_parts(list, s, random, options);
}

float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    return subsets_of_parts_probability(
        list, make_predictor(s, options), find_light(list, emitter), random, options.subset_length);
}

#endif
