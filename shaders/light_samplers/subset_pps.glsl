// SPDX-License-Identifier: GPL-2.0-or-later
// `subset_dynamic` whose static subset is a systematic sample with probability proportional to size (PPS; Madow 1949,
// "On the Theory of Systematic Sampling, II"): it is drawn from the cluster's multiset, in which a light stands as
// often as it is likely to matter there. Each entry is a light of its own that sends the light's share, so that nothing
// else differs and the estimate stays unbiased.
#ifndef VKPT_LIGHT_SAMPLER_SUBSET_PPS
#define VKPT_LIGHT_SAMPLER_SUBSET_PPS

#include "../lib/light_subsets.glsl"

// clang-format off
const uint light_sampler_traits = SAMPLER_USES_SUBSET | SAMPLER_DRAWS_ENTRIES | SAMPLER_NEEDS_MULTISETS | SAMPLER_WEIGHS_VISIBILITY;
// clang-format on

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    return sample_subsets_of_parts(likely_lights(list, options.subset_length), s, random, options);
}

// Of one of the light's entries, at random, and as if each were as likely to be picked.
float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    LightListView likely = likely_lights(list, options.subset_length);
    uint state = start_fast_random(random.more);
    int place = find_light_entry(likely, emitter, next_fast_random(state));
    return subsets_of_parts_probability(likely, make_predictor(s, options), place, random, options.subset_length);
}

#endif
