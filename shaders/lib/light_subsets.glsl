// SPDX-License-Identifier: GPL-2.0-or-later
// Subsets of a light list: S = ceil(K / R) strides of consecutive lights, of which each gives one light to the subset.
// Other than in the text of section 47.4.1, S is not floor(K / R): the lights past R strides would never be reached.
#ifndef VKPT_LIB_LIGHT_SUBSETS
#define VKPT_LIB_LIGHT_SUBSETS

#include "light_sampler.glsl"

// Longer subsets than this are cut to it (weights are kept in an array).
const uint max_subset_length = 64u;

uint subset_stride(uint count, uint subset_length)
{
    uint length_limit = clamp(subset_length, 1u, max_subset_length);
    return max(divide_whole(count + length_limit - 1u, length_limit), 1u);
}

uint subset_stride(LightListView list, uint subset_length) { return subset_stride(list.counted, subset_length); }

// One number decides the subset, and what remains of it the light in the subset: each light owns one interval.
struct SubsetChoice {
    uint stride; // S
    uint offset; // of the subset's light in each stride
    float rest; // in [0, 1)
};

SubsetChoice choose_subset(uint count, float xi, uint subset_length)
{
    SubsetChoice choice;
    choice.stride = subset_stride(count, subset_length);
    choice.offset = choose_uniformly(xi, choice.stride);
    choice.rest = quick_clamp(xi * float(choice.stride) - float(choice.offset), 0.0f, max_below_one);
    return choice;
}

SubsetChoice choose_subset(LightListView list, float xi, uint subset_length)
{
    return choose_subset(list.counted, xi, subset_length);
}

// The sums of the weights so far. CPU drivers write an array lane by lane, which took a seventh of the time of weighing
// a light, but to memory they can scatter: where the pass has some of its own for each lane (VKPT_LANE_MEMORY,
// max_subset_length entries of 64 bytes of which a float is used), the sums are there. On GPUs they are in lane_array.
#ifdef VKPT_LANE_MEMORY
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LaneFloat { float v; };
#define VKPT_SUMS uint64_t sums = VKPT_LANE_MEMORY
#define VKPT_CPU_SUM(i) LaneFloat(sums + uint64_t((i)*64u)).v
#else
#define VKPT_SUMS float sums[max_subset_length]
#define VKPT_CPU_SUM(i) sums[i]
#endif
#ifdef __cplusplus
#define VKPT_SUM(i) VKPT_CPU_SUM(i)
#define VKPT_KEEP_SUM(i, sum) VKPT_CPU_SUM(i) = sum
#else
#include "device/lanes.glsl"
#define VKPT_SUM(i) (has_gpu_lanes ? uintBitsToFloat(lane_array[i].x) : VKPT_CPU_SUM(i))
#define VKPT_KEEP_SUM(i, sum)                                                                                          \
    if (has_gpu_lanes)                                                                                                 \
        lane_array[i].x = floatBitsToUint(sum);                                                                        \
    else                                                                                                               \
        VKPT_CPU_SUM(i) = sum
#endif

// The list to draw candidates from: a multiset, where the list is longer than a subset, which else would hold all of
// it.
LightListView likely_lights(LightListView list, uint subset_length)
{
    return list.range.static_count > subset_length ? open_multiset(list) : list;
}

// Listing 47-1 from line 6 on, with what `others` holds behind the subset's lights. It keeps the sums of the weights so
// far instead of the weights: they are sorted, so that the second sweep is a search that halves what is left, and a
// light's chance is its interval to the last bit.
LightSample sample_subset_in_two_sweeps(
    LightListView list, LightPredictor predictor, SubsetChoice choice, Reservoir others, LightRandom random)
{
    uint count = light_count(list);
    VKPT_SUMS;
    float subset_total = 0.0f;
    uint length_used = 0u;
    for (uint position = choice.offset; position < count && length_used < max_subset_length;
         position += choice.stride) {
        subset_total += weigh_light(list, predictor, position);
        VKPT_KEEP_SUM(length_used, subset_total);
        length_used += 1u;
    }
    float total = subset_total + others.total;
    if (!(total > 0.0f))
        return no_light();

    // The first sum above the threshold, which rounding must not lift to the last one: its light has weight.
    float threshold = quick_min(choice.rest * total, total * max_below_one);
    if (threshold >= subset_total)
        return make_light_sample(uint(others.emitter), others.weight / (total * float(choice.stride)), random);
    uint low = 0u, high = length_used - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (VKPT_SUM(middle) > threshold)
            high = middle;
        else
            low = middle + 1u;
    }
    float before = VKPT_SUM(max(low, 1u) - 1u);
    float mass = VKPT_SUM(low) - (low > 0u ? before : 0.0f);
    LightEntry entry = light_entry_at(list, choice.offset + low * choice.stride);
    return make_light_sample(entry.emitter, mass / (total * float(choice.stride) * entry.share), random);
}

LightSample sample_strided_subset(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    if (light_count(list) == 0u)
        return no_light();
    SubsetChoice choice = choose_subset(list, random.light, options.subset_length);
    return sample_subset_in_two_sweeps(list, make_predictor(s, options), choice, make_reservoir(0.0f), random);
}

// Listing 47-2 from line 6 on: one sweep, with a number of its own.
Reservoir sweep_subset(LightListView list, LightPredictor predictor, SubsetChoice choice, float xi)
{
    uint count = light_count(list);
    Reservoir reservoir = make_reservoir(xi);
    for (uint position = choice.offset; position < count; position += choice.stride) {
        uint emitter = light_at(list, position);
        update_reservoir(reservoir, emitter, weigh_emitter(list, predictor, emitter));
    }
    return reservoir;
}

// A subset of the static lights and one of the dynamic ones, positions counted from the part's first light.
struct PartChoices {
    SubsetChoice of_static;
    SubsetChoice of_dynamic;
};

// One number for all: what the first offset leaves of it decides the second one, and what that leaves the light.
PartChoices choose_parts(LightListView list, float xi, uint subset_length)
{
    PartChoices choices;
    choices.of_static = choose_subset(static_lights(list), xi, subset_length);
    choices.of_dynamic = choose_subset(dynamic_lights(list), choices.of_static.rest, subset_length);
    choices.of_static.rest = choices.of_dynamic.rest;
    return choices;
}

// With S and T strides, offsets i and j, sums of weights W_i of static and V_j of dynamic lights, a light of weight w
// is picked with probability w / (S W_i + T V_j), whichever part it is from: given the other part's offset, that is its
// chance over the offsets of its own (1 / S or 1 / T for the right one, and then S w or T w of all), so dividing by it
// is unbiased as in equation 47.19.
LightSample sample_subsets_of_parts(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    if (light_count(list) == 0u)
        return no_light();
    PartChoices choices = choose_parts(list, random.light, options.subset_length);
    LightPredictor predictor = make_predictor(s, options);
    LightListView moving = dynamic_lights(list);
    Reservoir others = make_reservoir(0.0f);
    if (light_count(moving) > 0u) {
        uint state = start_fast_random(random.more);
        others = sweep_subset(moving, without_visibility(predictor), choices.of_dynamic, next_fast_random(state));
        // One of the static subset's lights stands for so many, one of these for so many others.
        others.total *= float(choices.of_dynamic.stride) / float(choices.of_static.stride);
    }
    return sample_subset_in_two_sweeps(static_lights(list), predictor, choices.of_static, others, random);
}

// Of the light that stands at `place`, -1: 0.
float subsets_of_parts_probability(
    LightListView list, LightPredictor predictor, int place, LightRandom random, uint subset_length)
{
    if (place < 0)
        return 0.0f;
    PartChoices choices = choose_parts(list, random.light, subset_length);
    uint static_count = list.range.static_count;
    if (uint(place) < static_count)
        choices.of_static.offset = remainder_whole(uint(place), choices.of_static.stride);
    else
        choices.of_dynamic.offset = remainder_whole(uint(place) - static_count, choices.of_dynamic.stride);
    float total = 0.0f;
    SubsetChoice choice = choices.of_static;
    LightListView lights = static_lights(list);
    LightPredictor of_part = predictor;
    ROLLED_FOR (uint part = 0u; part < 2u; part++) {
        total += float(choice.stride) * weigh_lights(lights, of_part, choice.offset, choice.stride);
        choice = choices.of_dynamic;
        lights = dynamic_lights(list);
        of_part = without_visibility(predictor);
    }
    if (uint(place) < static_count)
        of_part = predictor;
    float weight = weigh_emitter(list, of_part, light_at(list, uint(place)));
    return weight > 0.0f ? weight / total : 0.0f;
}

// The light that a reservoir has kept of a subset with one light of each stride.
LightSample make_subset_sample(Reservoir reservoir, uint stride, LightRandom random)
{
    if (reservoir.emitter < 0)
        return no_light();
    return make_light_sample(uint(reservoir.emitter), reservoir.weight / (reservoir.total * float(stride)), random);
}

// The light's place in the list tells the only subset of equal offsets that holds it, so no random number matters.
float strided_subset_probability(LightListView list, LightPredictor predictor, uint emitter, uint subset_length)
{
    int place = find_light(list, emitter);
    if (place < 0)
        return 0.0f;
    uint stride = subset_stride(list, subset_length);
    float mass = weigh_light(list, predictor, uint(place));
    float total = weigh_lights(list, predictor, remainder_whole(uint(place), stride), stride);
    return mass > 0.0f ? mass / (total * float(stride)) : 0.0f;
}

// Listing 47-3 without its MIS: each stride has an offset of its own, and a reservoir chooses within the subset. Given
// the other strides' offsets, a light of weight w is picked with probability w / (S (their weights + w)), and that is
// reported.
LightSample sample_independent_strides(
    LightListView list, LightPredictor predictor, LightRandom random, uint subset_length)
{
    uint count = light_count(list);
    if (count == 0u)
        return no_light();
    uint stride = subset_stride(list, subset_length);
    uint state = start_fast_random(random.more);
    Reservoir reservoir = make_reservoir(random.light);
    for (uint first = 0u; first < count; first += stride) {
        uint position = first + choose_uniformly(next_fast_random(state), stride);
        if (position >= count) // the last stride may be short: then it gives no light
            break;
        uint emitter = light_at(list, position);
        update_reservoir(reservoir, emitter, weigh_emitter(list, predictor, emitter));
    }
    return make_subset_sample(reservoir, stride, random);
}

// Equation 47.20: averaged over the offset of the stride that holds `emitter`, for the other strides' offsets as drawn
// by sample_independent_strides.
float independent_strides_probability(
    LightListView list, LightPredictor predictor, uint emitter, LightRandom random, uint subset_length)
{
    int place = find_light(list, emitter);
    if (place < 0)
        return 0.0f;
    uint count = light_count(list);
    uint stride = subset_stride(list, subset_length);
    uint state = start_fast_random(random.more);
    float total = 0.0f, mass = 0.0f;
    for (uint first = 0u; first < count; first += stride) {
        uint position = first + choose_uniformly(next_fast_random(state), stride);
        bool own_stride = uint(place) - first < stride; // unsigned: false where the place lies before
        if (own_stride)
            position = uint(place);
        if (position >= count)
            break;
        float weight = weigh_light(list, predictor, position);
        total += weight;
        if (own_stride)
            mass = weight;
    }
    return mass > 0.0f ? mass / (total * float(stride)) : 0.0f;
}

#endif
