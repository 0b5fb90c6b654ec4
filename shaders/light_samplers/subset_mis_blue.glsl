// SPDX-License-Identifier: GPL-2.0-or-later
// Pseudo-marginal MIS whose error stays blue: `subset_mis`, other than that
// - the offset in each stride is a random dimension of its own, so with pt_noise blue a mask of its own. For a pixel the
//   offsets are independent all the same, which is all that section 47.5 asks for. With weights that are proportional to the
//   contributions the estimate is S (w_1(u_1) + ... + w_R(u_R)): functions of one mask each, whose errors are blue;
// - both techniques are weighted by the power heuristic: light sampling alone keeps what it does well, and the ray's hits,
//   on which no mask helps, count where its density is much the higher one.
// Unbiased: docs/light-sampling.md, "Random numbers and their spectrum".
#ifndef VKPT_LIGHT_SAMPLER_SUBSET_MIS_BLUE
#define VKPT_LIGHT_SAMPLER_SUBSET_MIS_BLUE

#define VKPT_MIS_POWER_HEURISTIC
#include "../lib/light_subsets.glsl"

const bool light_sampler_mis = true;

// The place in the list that stride `index` gives to the subset; past the end in a short last stride: none.
uint choose_in_stride(LightRandom random, uint index, uint stride)
{
    return index * stride + choose_uniformly(random_dimension(random.more, index), stride);
}

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    uint count = light_count(list);
    if (count == 0u)
        return no_light();
    LightPredictor predictor = make_predictor(s, options);
    uint stride = subset_stride(list.counted, options.subset_length);
    Reservoir reservoir = make_reservoir(random.light);
    for (uint index = 0u; index * stride < count; index++) {
        uint position = choose_in_stride(random, index, stride);
        if (position >= count)
            break;
        uint emitter = light_at(list, position);
        offer_light(reservoir, emitter, weigh_emitter(list, predictor, emitter));
    }
    return make_subset_sample(reservoir, stride, random);
}

// Equation 47.20, as in independent_strides_probability.
float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    int place = find_light(list, emitter);
    if (place < 0)
        return 0.0f;
    LightPredictor predictor = make_predictor(s, options);
    uint count = light_count(list);
    uint stride = subset_stride(list.counted, options.subset_length);
    float total = 0.0f;
    float mass = 0.0f;
    for (uint index = 0u; index * stride < count; index++) {
        bool own_stride = uint(place) - index * stride < stride; // unsigned: false where the place lies before
        uint position = own_stride ? uint(place) : choose_in_stride(random, index, stride);
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
