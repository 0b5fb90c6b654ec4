// SPDX-License-Identifier: GPL-2.0-or-later
// Every light of the list with the same probability: the baseline.
#ifndef VKPT_LIGHT_SAMPLER_UNIFORM
#define VKPT_LIGHT_SAMPLER_UNIFORM

#include "../lib/light_sampler.glsl"

LightSample sample_light(LightListView list, Surface s, float xi, uint subset_length)
{
    uint count = light_count(list);
    if (count == 0u)
        return no_light();
    return make_light_sample(light_at(list, choose_uniformly(xi, count)), 1.0f / float(count));
}

float light_probability(LightListView list, Surface s, uint emitter, float xi, uint subset_length)
{
    return find_light(list, emitter) >= 0 ? 1.0f / float(light_count(list)) : 0.0f;
}

#endif
