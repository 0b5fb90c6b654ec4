// SPDX-License-Identifier: GPL-2.0-or-later
// Listing 47-1: a strided subset of the list, then a light of it by predicted contribution, in two sweeps with one random
// number. Each light owns one interval of xi, so that blue noise in xi stays blue in the picture.
// Other than in the text, the stride is ceil(K / R): with floor, the lights past R strides would never be reached.
#ifndef VKPT_LIGHT_SAMPLER_SUBSET
#define VKPT_LIGHT_SAMPLER_SUBSET

#include "../lib/light_sampler.glsl"

uint subset_stride(uint count, uint subset_length)
{
    uint length_limit = clamp(subset_length, 1u, max_subset_length);
    return (count + length_limit - 1u) / length_limit;
}

LightSample sample_light(LightListView list, Surface s, float xi, uint subset_length)
{
    uint count = light_count(list);
    if (count == 0u)
        return no_light();
    uint stride = subset_stride(count, subset_length);
    uint offset = choose_uniformly(xi, stride);
    float rest = clamp(xi * float(stride) - float(offset), 0.0f, max_below_one);

    float weights[max_subset_length];
    float total = 0.0f;
    uint length_used = 0u;
    for (uint position = offset; position < count; position += stride) {
        float weight = light_contribution(s, load_emitter(list, light_at(list, position)));
        weights[length_used] = weight;
        total += weight;
        length_used += 1u;
    }
    if (!(total > 0.0f))
        return no_light();

    // Lights of weight 0 own no interval. Rounding may leave a rest behind the last one: that belongs to the last with weight.
    float threshold = rest * total;
    uint chosen = 0u;
    float mass = 0.0f;
    for (uint i = 0u; i < length_used; i++) {
        if (weights[i] <= 0.0f)
            continue;
        chosen = i;
        mass = weights[i];
        if (threshold < mass)
            break;
        threshold -= mass;
    }
    return make_light_sample(light_at(list, offset + chosen * stride), mass / (total * float(stride)));
}

// The light's place in the list tells the only subset that holds it, so its probability needs no xi.
float light_probability(LightListView list, Surface s, uint emitter, float xi, uint subset_length)
{
    int position = find_light(list, emitter);
    if (position < 0)
        return 0.0f;
    uint count = light_count(list);
    uint stride = subset_stride(count, subset_length);
    float total = 0.0f;
    for (uint other = uint(position) % stride; other < count; other += stride)
        total += light_contribution(s, load_emitter(list, light_at(list, other)));
    float mass = light_contribution(s, load_emitter(list, emitter));
    return mass > 0.0f ? mass / (total * float(stride)) : 0.0f;
}

#endif
