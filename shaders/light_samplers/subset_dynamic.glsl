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

struct PartChoices {
    SubsetChoice of_static;
    SubsetChoice of_dynamic; // positions counted from the first of them
};

// One number for all: what the first offset leaves of it decides the second one, and what that leaves the light.
PartChoices choose_parts(LightListView list, float xi, uint subset_length)
{
    PartChoices choices;
    choices.of_static = choose_subset(list.range.static_count, xi, subset_length);
    choices.of_dynamic = choose_subset(list.counted - list.range.static_count, choices.of_static.rest, subset_length);
    choices.of_static.rest = choices.of_dynamic.rest;
    return choices;
}

// A light of the dynamic subset; its weight as if it stood among the static one's.
OtherLight choose_dynamic_light(LightListView list, LightPredictor predictor, PartChoices choices, LightRandom random)
{
    OtherLight other = no_other_light();
    uint first = list.range.static_count, count = light_count(list);
    if (first >= count)
        return other;
    uint state = start_fast_random(random.more);
    Reservoir reservoir = make_reservoir(next_fast_random(state));
    for (uint position = first + choices.of_dynamic.offset; position < count; position += choices.of_dynamic.stride) {
        uint emitter = light_at(list, position);
        offer_light(reservoir, emitter, weigh_emitter(list, predictor, emitter));
    }
    other.emitter = reservoir.emitter;
    other.weight = reservoir.weight;
    other.total = reservoir.total * float(choices.of_dynamic.stride) / float(choices.of_static.stride);
    return other;
}

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    if (light_count(list) == 0u)
        return no_light();
    PartChoices choices = choose_parts(list, random.light, options.subset_length);
    LightPredictor predictor = make_predictor(s, options);
    OtherLight other = choose_dynamic_light(list, predictor, choices, random);
    return sample_subset_in_two_sweeps(list, predictor, list.range.static_count, choices.of_static, other, random);
}

// What the lights of one part weigh that are `stride` apart.
float weigh_part(LightListView list, LightPredictor predictor, uint first, uint end, uint stride)
{
    float total = 0.0f;
    for (uint position = first; position < end; position += stride)
        total += weigh_light(list, predictor, position);
    return total;
}

float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    int place = find_light(list, emitter);
    if (place < 0)
        return 0.0f;
    LightPredictor predictor = make_predictor(s, options);
    PartChoices choices = choose_parts(list, random.light, options.subset_length);
    uint static_count = list.range.static_count;
    bool is_dynamic = uint(place) >= static_count;
    uint static_offset = is_dynamic ? choices.of_static.offset : uint(place) % choices.of_static.stride;
    uint dynamic_offset = is_dynamic ? (uint(place) - static_count) % choices.of_dynamic.stride : choices.of_dynamic.offset;
    float total = float(choices.of_static.stride) * weigh_part(list, predictor, static_offset, static_count, choices.of_static.stride)
        + float(choices.of_dynamic.stride)
            * weigh_part(list, predictor, static_count + dynamic_offset, light_count(list), choices.of_dynamic.stride);
    float weight = weigh_light(list, predictor, uint(place));
    return weight > 0.0f ? weight / total : 0.0f;
}

#endif
