// SPDX-License-Identifier: GPL-2.0-or-later
// BIASED, for comparison (figure 47-7, right): MIS as in `subset_mis`, but all strides share one offset as in `subset`.
// That keeps the stratification. But the offset that brought a light in also chose the other lights of its subset,
// while an emitter that a BSDF ray met is put among lights of another offset: the two weights of a point do not add up
// to 1.
#ifndef VKPT_LIGHT_SAMPLER_SUBSET_MIS_BIASED
#define VKPT_LIGHT_SAMPLER_SUBSET_MIS_BIASED

#include "../lib/light_subsets.glsl"

const uint light_sampler_traits = SAMPLER_MIS | SAMPLER_BIASED | SAMPLER_USES_SUBSET;

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    return sample_strided_subset(list, s, random, options);
}

float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    int place = find_light(list, emitter);
    if (place < 0)
        return 0.0f;
    LightPredictor predictor = make_predictor(s, options);
    uint count = light_count(list);
    SubsetChoice choice = choose_subset(list, random.light, options.subset_length);
    float mass = weigh_light(list, predictor, uint(place));
    float total = mass;
    for (uint first = 0u; first < count; first += choice.stride) {
        bool own_stride = uint(place) - first < choice.stride;
        if (!own_stride && first + choice.offset < count)
            total += weigh_light(list, predictor, first + choice.offset);
    }
    return mass > 0.0f ? mass / (total * float(choice.stride)) : 0.0f;
}

#endif
