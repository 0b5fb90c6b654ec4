// SPDX-License-Identifier: GPL-2.0-or-later
// Pseudo-marginal MIS whose error stays blue: `subset_mis`, other than that
// - the offset in each stride is a random dimension of its own, so with pt_noise blue a mask of its own. For a pixel
// the
//   offsets are independent all the same, which is all that section 47.5 asks for. With weights that are proportional
//   to the contributions the estimate is S (w_1(u_1) + ... + w_R(u_R)): functions of one mask each, whose errors are
//   blue;
// - both techniques are weighted by the power heuristic: light sampling alone keeps what it does well, and the ray's
// hits,
//   on which no mask helps, count where its density is much the higher one;
// - dynamic lights have strides of their own, and static ones are drawn from the cluster's multiset, as in
// `subset_pps`. Unbiased: docs/light-sampling.md, "Random numbers and their spectrum".
#ifndef VKPT_LIGHT_SAMPLER_SUBSET_MIS_BLUE
#define VKPT_LIGHT_SAMPLER_SUBSET_MIS_BLUE

#define VKPT_MIS_POWER_HEURISTIC
#include "../lib/light_subsets.glsl"

const uint light_sampler_traits = SAMPLER_MIS | SAMPLER_USES_SUBSET | SAMPLER_DRAWS_ENTRIES | SAMPLER_NEEDS_MULTISETS;

// Random dimensions: the offsets in static strides first, then those in dynamic ones.
const uint first_dynamic_dimension = max_subset_length;
const uint entry_dimension = 2u * max_subset_length;

// Static or dynamic lights, cut into strides.
struct StridedPart {
    LightListView lights;
    uint stride;
    uint first_dimension;
};

StridedPart cut_into_strides(LightListView lights, uint first_dimension, uint subset_length)
{
    StridedPart part;
    part.lights = lights;
    part.stride = subset_stride(lights, subset_length);
    part.first_dimension = first_dimension;
    return part;
}

// The place that stride `index` gives to the subset; past the end in a short last stride: none.
uint choose_in_stride(StridedPart part, LightRandom random, uint index)
{
    float xi = random_dimension(random.more, part.first_dimension + index);
    return index * part.stride + choose_uniformly(xi, part.stride);
}

// Each entry weighs as much as its stride is long. Returns what the weight of the light that the reservoir holds now
// was multiplied by; `scale`: that of the one that it held before.
float offer_part(
    INOUT(Reservoir) reservoir, float scale, StridedPart part, LightPredictor predictor, LightRandom random)
{
    uint count = light_count(part.lights);
    for (uint index = 0u; index * part.stride < count; index++) {
        uint position = choose_in_stride(part, random, index);
        if (position >= count)
            break;
        LightEntry entry = light_entry_at(part.lights, position);
        float entry_scale = entry.share * float(part.stride);
        bool taken = update_reservoir(
            reservoir, entry.emitter, weigh_emitter(part.lights, predictor, entry.emitter) * entry_scale);
        scale = taken ? entry_scale : scale;
    }
    return scale;
}

// Given the other strides' offsets, an entry of weight w in a stride of length S is picked with probability
// (1 / S) S w / (sum of all), and the light, of which it is one in m, is reported with m times that.
LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    if (light_count(list) == 0u)
        return no_light();
    LightListView likely = likely_lights(list, options.subset_length);
    LightPredictor predictor = make_predictor(s, options);
    Reservoir reservoir = make_reservoir(random.light);
    float scale = offer_part(
        reservoir, 1.0f, cut_into_strides(static_lights(likely), 0u, options.subset_length), predictor, random);
    scale = offer_part(reservoir, scale,
        cut_into_strides(dynamic_lights(likely), first_dynamic_dimension, options.subset_length), predictor, random);
    if (reservoir.emitter < 0)
        return no_light();
    return make_light_sample(uint(reservoir.emitter), reservoir.weight / (reservoir.total * scale), random);
}

// What the entries of a part's subset weigh. The entry at `place`, if it is in the part, stands for its stride.
float weigh_part(StridedPart part, LightPredictor predictor, LightRandom random, uint place)
{
    uint count = light_count(part.lights);
    float total = 0.0f;
    for (uint index = 0u; index * part.stride < count; index++) {
        bool own_stride = place - index * part.stride < part.stride; // unsigned: false where the place lies before
        uint position = own_stride ? place : choose_in_stride(part, random, index);
        if (position >= count)
            break;
        total += weigh_light(part.lights, predictor, position);
    }
    return total * float(part.stride);
}

// Equation 47.20, as in independent_strides_probability, for one of the emitter's entries at random.
float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    LightListView likely = likely_lights(list, options.subset_length);
    int found = find_light_entry(likely, emitter, random_dimension(random.more, entry_dimension));
    if (found < 0)
        return 0.0f;
    const uint nowhere = 0x80000000u;
    uint place = uint(found), static_count = likely.range.static_count;
    LightPredictor predictor = make_predictor(s, options);
    float total = weigh_part(cut_into_strides(static_lights(likely), 0u, options.subset_length), predictor, random,
                      place < static_count ? place : nowhere)
        + weigh_part(cut_into_strides(dynamic_lights(likely), first_dynamic_dimension, options.subset_length),
            predictor, random, place < static_count ? nowhere : place - static_count);
    float weight = weigh_emitter(likely, predictor, emitter);
    return weight > 0.0f ? weight / total : 0.0f;
}

#endif
