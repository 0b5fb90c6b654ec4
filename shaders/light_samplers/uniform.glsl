// SPDX-License-Identifier: GPL-2.0-or-later
// Every light of the list with the same probability: the baseline.
#ifndef VKPT_LIGHT_SAMPLER_UNIFORM
#define VKPT_LIGHT_SAMPLER_UNIFORM

#include "../lib/light_sampler.glsl"

const uint light_sampler_traits = SAMPLER_NEWCOMERS_APART;

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    uint count = light_count(list);
    if (count == 0u)
        return no_light();
    return make_light_sample(light_at(list, choose_uniformly(random.light, count)), 1.0f / float(count), random);
}

float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    return find_light(list, emitter) >= 0 ? 1.0f / float(light_count(list)) : 0.0f;
}

#endif
