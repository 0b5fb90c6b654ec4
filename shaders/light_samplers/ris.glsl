// SPDX-License-Identifier: GPL-2.0-or-later
// Resampled importance sampling (Talbot et al. 2005; Bikker's use for lights, section 47.3.1): M = pt_light_subset
// candidate points, each on a light chosen uniformly, of which one is kept with a probability proportional to its
// unshadowed light over its density: F = f(y) / phat(y) * mean(phat / q).
#ifndef VKPT_LIGHT_SAMPLER_RIS
#define VKPT_LIGHT_SAMPLER_RIS

#include "../lib/light_sampler.glsl"

const uint light_sampler_traits = SAMPLER_USES_SUBSET | SAMPLER_DRAWS_POINTS | SAMPLER_NEWCOMERS_APART;
const uint max_candidates = 64u;

struct LightCandidate {
    uint emitter;
    vec2 point;
    float weight; // phat / q, the candidate light's probability 1 / K left out of q
};

float weigh_candidate(LightListView list, Surface s, uint emitter, vec2 point, LightOptions options)
{
    Emitter e = load_emitter(list, emitter);
    EmitterSample drawn = sample_emitter_point(e, s, point, options);
    if (drawn.pdf <= 0.0f)
        return 0.0f;
    vec3 light = reflected_radiance(s, evaluate_bsdf(s, drawn.direction), drawn.radiance);
    return min(luminance(light) / drawn.pdf, max_contribution);
}

LightCandidate draw_candidate(LightListView list, Surface s, INOUT(uint) state, LightOptions options)
{
    LightCandidate candidate;
    candidate.emitter = light_at(list, choose_uniformly(next_fast_random(state), light_count(list)));
    float x = next_fast_random(state);
    float y = next_fast_random(state);
    candidate.point = vec2(x, y);
    candidate.weight = weigh_candidate(list, s, candidate.emitter, candidate.point, options);
    return candidate;
}

// phat / (density of the point * mean(phat / q)): no probability, but the estimate divides by it as by one.
float candidate_probability(LightListView list, float weight, float total, uint candidates)
{
    return weight * float(candidates) / (total * float(light_count(list)));
}

LightSample sample_light(LightListView list, Surface s, LightRandom random, LightOptions options)
{
    if (light_count(list) == 0u)
        return no_light();
    uint candidates = clamp(options.subset_length, 1u, max_candidates);
    uint state = start_fast_random(random.more);
    Reservoir reservoir = make_reservoir(random.light);
    vec2 point = random.point;
    for (uint i = 0u; i < candidates; i++) {
        LightCandidate candidate = draw_candidate(list, s, state, options);
        if (update_reservoir(reservoir, candidate.emitter, candidate.weight))
            point = candidate.point;
    }
    if (reservoir.emitter < 0)
        return no_light();
    float probability = candidate_probability(list, reservoir.weight, reservoir.total, candidates);
    LightSample result = make_light_sample(uint(reservoir.emitter), probability, random);
    result.point = point;
    return result;
}

// With a point of `emitter` in the place of the first candidate.
float light_probability(LightListView list, Surface s, uint emitter, LightRandom random, LightOptions options)
{
    if (find_light(list, emitter) < 0)
        return 0.0f;
    uint candidates = clamp(options.subset_length, 1u, max_candidates);
    uint state = start_fast_random(random.more);
    float mass = weigh_candidate(list, s, emitter, random.point, options);
    float total = mass;
    for (uint i = 1u; i < candidates; i++) {
        LightCandidate candidate = draw_candidate(list, s, state, options);
        total += candidate.weight;
    }
    return mass > 0.0f ? candidate_probability(list, mass, total, candidates) : 0.0f;
}

#endif
