// SPDX-License-Identifier: GPL-2.0-or-later
// `subset` with a subset of its own for the dynamic lights: muzzle flashes, projectiles, explosions, whatever moves. They are few and
// often outshine all others, but a subset of the whole list holds a given one only once in S times. Here, as long as they are no
// more than R, each is weighed every time. Without dynamic lights this is `subset` to the last bit.
//
// With S and T strides, offsets i and j, sums of weights W_i of static and V_j of dynamic lights, a light of weight w is picked with
// probability w / (S W_i + T V_j), whichever part it is from: given the other part's offset, that is its chance over the offsets of
// its own (1 / S or 1 / T for the right one, and then S w or T w of all), so dividing by it is unbiased as in equation 47.19.
#ifndef VKPT_LIGHT_SAMPLER_SUBSET_DYNAMIC
#define VKPT_LIGHT_SAMPLER_SUBSET_DYNAMIC

#include "../lib/light_subsets.glsl"

const bool light_sampler_mis = false;

// A subset of either part, positions counted from the part's first light.
struct PartChoices {
    SubsetChoice of_static;
    SubsetChoice of_dynamic;
};

// One number for all: what the first offset leaves of it decides the second one, and what that leaves the light.
PartChoices choose_parts(LightListView list, float xi, uint subset_length)
{
    PartChoices choices;
    choices.of_static = choose_subset(static_lights(list).counted, xi, subset_length);
    choices.of_dynamic = choose_subset(dynamic_lights(list).counted, choices.of_static.rest, subset_length);
    choices.of_static.rest = choices.of_dynamic.rest;
    return choices;
}

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    if (light_count(list) == 0u)
        return no_light();
    PartChoices choices = choose_parts(list, random.light, options.subset_length);
    LightPredictor predictor = make_predictor(s, options);
    LightListView moving = dynamic_lights(list);
    Reservoir others = make_reservoir(0.0f);
    if (light_count(moving) > 0u) {
        uint state = start_fast_random(random.more);
        others = sweep_subset(moving, predictor, choices.of_dynamic, next_fast_random(state));
        // One of the static subset's lights stands for so many, one of these for so many others.
        others.total *= float(choices.of_dynamic.stride) / float(choices.of_static.stride);
    }
    return sample_subset_in_two_sweeps(static_lights(list), predictor, choices.of_static, others, random);
}

float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    int place = find_light(list, emitter);
    if (place < 0)
        return 0.0f;
    LightPredictor predictor = make_predictor(s, options);
    PartChoices choices = choose_parts(list, random.light, options.subset_length);
    uint static_count = list.range.static_count;
    if (uint(place) < static_count)
        choices.of_static.offset = remainder_whole(uint(place), choices.of_static.stride);
    else
        choices.of_dynamic.offset = remainder_whole(uint(place) - static_count, choices.of_dynamic.stride);
    float total = float(choices.of_static.stride)
            * weigh_lights(static_lights(list), predictor, choices.of_static.offset, choices.of_static.stride)
        + float(choices.of_dynamic.stride)
            * weigh_lights(dynamic_lights(list), predictor, choices.of_dynamic.offset, choices.of_dynamic.stride);
    float weight = weigh_light(list, predictor, uint(place));
    return weight > 0.0f ? weight / total : 0.0f;
}

#endif
