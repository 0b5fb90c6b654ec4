// SPDX-License-Identifier: GPL-2.0-or-later
// The whole list by predicted contribution: what the subsets approximate (P(l | J) of equation 47.7). Its cost grows
// with the list. The weights of at most 64 runs of lights are summed first; only the chosen run is swept again.
#ifndef VKPT_LIGHT_SAMPLER_FULL
#define VKPT_LIGHT_SAMPLER_FULL

#include "../lib/light_sampler.glsl"

const uint light_sampler_traits = 0u;
const uint max_light_runs = 64u;

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    uint count = light_count(list);
    uint run_length = (count + max_light_runs - 1u) / max_light_runs;
    LightPredictor predictor = make_predictor(s, options);
    float sums[max_light_runs];
    float total = 0.0f;
    uint runs = 0u;
    for (uint first = 0u; first < count; first += run_length) {
        float sum = 0.0f;
        for (uint position = first; position < min(first + run_length, count); position++)
            sum += weigh_light(list, predictor, position);
        sums[runs] = sum;
        total += sum;
        runs += 1u;
    }
    if (!(total > 0.0f))
        return no_light();

    // Rounding may leave a rest behind the last interval: it belongs to the last run, and in a run to the last light,
    // that has weight.
    float threshold = random.light * total;
    uint chosen_run = 0u;
    for (uint i = 0u; i < runs; i++) {
        if (sums[i] <= 0.0f)
            continue;
        chosen_run = i;
        if (threshold < sums[i])
            break;
        threshold -= sums[i];
    }
    uint chosen = 0u;
    float mass = 0.0f;
    uint first = chosen_run * run_length;
    for (uint position = first; position < min(first + run_length, count); position++) {
        float weight = weigh_light(list, predictor, position);
        if (weight <= 0.0f)
            continue;
        chosen = position;
        mass = weight;
        if (threshold < weight)
            break;
        threshold -= weight;
    }
    return make_light_sample(light_at(list, chosen), mass / total, random);
}

float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    int place = find_light(list, emitter);
    if (place < 0)
        return 0.0f;
    LightPredictor predictor = make_predictor(s, options);
    float mass = weigh_light(list, predictor, uint(place));
    return mass > 0.0f ? mass / weigh_lights(list, predictor, 0u, 1u) : 0.0f;
}

#endif
