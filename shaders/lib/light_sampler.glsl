// SPDX-License-Identifier: GPL-2.0-or-later
// What light samplers share. shared/light_sampler.h is the contract that each fulfils.
#ifndef VKPT_LIB_LIGHT_SAMPLER
#define VKPT_LIB_LIGHT_SAMPLER

#include "../shared/light_sampler.h"
#include "../shared/light_visibility.h"
#include "bsdf.glsl"
#include "emitters.glsl"
#include "light_lists.glsl"
#include "light_weights.glsl"
#include "random.glsl"
#include "device/whole_numbers.glsl"

// The random numbers of one choice. `light` and `point` are dimensions of their own, stratified over the image.
struct LightRandom {
    float light; // in [0, 1): which light
    vec2 point; // which point on it
    Random more; // what a sampler draws beyond that, dimensions from 0 on, independent of the above
};

struct LightSample {
    int emitter; // index into the emitter table, -1: none
    float probability;
    vec2 point; // random numbers for sample_emitter_point: LightRandom::point unless the sampler chose among points
};

const float max_below_one = 0.99999994f; // 1 - 2^-24
// In a surface's block of dimensions; the BSDF sample that led there has those before.
const uint first_light_dimension = 3u;

// The numbers of the light choice at a path's surface: 0 is the primary one. A pure function, so that a later pass
// knows what an earlier one drew.
LightRandom light_random(Random pixel_random, uint vertex)
{
    Random random = random_for_bounce(pixel_random, vertex + 1u);
    random.dimension += first_light_dimension;
    LightRandom result;
    vec3 numbers = next_vec3(random);
    result.light = numbers.x;
    result.point = vec2(numbers.y, numbers.z);
    result.more = random_stream(random, vertex + 1u);
    return result;
}

LightSample no_light()
{
    LightSample result;
    result.emitter = -1;
    result.probability = 0.0f;
    result.point = vec2(0.0f);
    return result;
}

LightSample make_light_sample(uint emitter, float probability, LightRandom random)
{
    LightSample result;
    result.emitter = int(emitter);
    result.probability = probability;
    result.point = random.point;
    return result;
}

// The share of a point's light that goes to one way to find it, of density `own` > 0; another has density `other`.
// Balance heuristic (equation 47.13), or Veach's power heuristic of exponent 2 for samplers that ask for it. The shares
// of the two ways add up to 1, which is what keeps both unbiased.
float mis_weight(float own, float other)
{
    float ratio = other / own;
#ifdef VKPT_MIS_POWER_HEURISTIC
    ratio *= ratio;
#endif
    return 1.0f / (1.0f + ratio);
}

// floor(xi * count), safe against rounding up to count; count <= 2^22.
uint choose_uniformly(float xi, uint count) { return min(floor_to_uint(xi * float(int(count))), count - 1u); }

LightShape unpack_light_shape(PackedLight packed)
{
    const uint kept = ~0u << (32u - PACKED_LIGHT_BITS), left = ~kept, more = 32u - PACKED_LIGHT_MORE_BITS;
    uint w0 = packed.shape[0], w1 = packed.shape[1], w2 = packed.shape[2], w3 = packed.shape[3];
    LightShape light;
    light.p0 = packed.p0;
    light.first = uintBitsToFloat(uvec3(w0 & kept, w1 & kept, w2 & kept));
    light.second = uintBitsToFloat(uvec3(w3 & kept, (w0 << PACKED_LIGHT_BITS) | ((w1 & left) << more),
        (w2 << PACKED_LIGHT_BITS) | ((w3 & left) << more)));
    light.side = uintBitsToFloat(packed.radiance << 23u);
    light.radius = uintBitsToFloat(w0);
    light.reach = uintBitsToFloat(w1);
    light.axis = w2;
    light.cosines = w3;
    light.is_sphere = int(packed.radiance) < 0;
    light.radiance = uintBitsToFloat(packed.radiance & PACKED_LIGHT_RADIANCE_MASK);
    return light;
}

LightShape load_light_shape(LightListView list, uint emitter)
{
#ifdef __cplusplus // tests on the CPU have no table of packed lights
    return unpack_light_shape(::vkpt::pack_light_shape(load_emitter(list, emitter), 1.0f));
#else
    return unpack_light_shape(VKPT_FETCH(PackedLight, list.tables.packed_lights, emitter));
#endif
}

// What of a light's weight is left by what shadow rays have told of it.
float believed_visibility(LightPredictor predictor, uint emitter)
{
    uint slot = emitter % VISIBILITY_SLOTS;
    uvec4 row = predictor.hidden;
    uint even = slot < 32u ? row.x : row.z, odd = slot < 32u ? row.y : row.w;
    uint thirds = (((slot & 16u) == 0u ? even : odd) >> ((slot & 15u) * 2u)) & 3u;
    return 1.0f - float(int(thirds)) * ((1.0f - VISIBILITY_LEAST) / 3.0f);
}

// For lights that the table does not know: those that are not the map's.
LightPredictor without_visibility(LightPredictor predictor)
{
    LightPredictor result = predictor;
    result.hidden = uvec4(0u);
    return result;
}

float weigh_emitter(LightListView list, LightPredictor predictor, uint emitter)
{
    return light_contribution(predictor, load_light_shape(list, emitter)) * believed_visibility(predictor, emitter);
}

float weigh_entry(LightListView list, LightPredictor predictor, LightEntry entry)
{
    return weigh_emitter(list, predictor, entry.emitter) * entry.share;
}

float weigh_light(LightListView list, LightPredictor predictor, uint position)
{
    return weigh_entry(list, predictor, light_entry_at(list, position));
}

// The sum of the weights of the lights at `first` and every `stride` from there on.
float weigh_lights(LightListView list, LightPredictor predictor, uint first, uint stride)
{
    uint count = light_count(list);
    float total = 0.0f;
    for (uint position = first; position < count; position += stride)
        total += weigh_light(list, predictor, position);
    return total;
}

// A cheap generator for many numbers in a row (PCG, RXS-M-XS 32 of O'Neill 2014). Its state starts as a hash of pixel,
// frame and dimension: seeding it from the number that chooses within the subset would correlate the two and bias the
// result.
uint start_fast_random(Random more)
{
    return hash_pcg4(uvec4(more.pixel.x | (more.pixel.y << 16u), more.frame, more.seed, more.dimension)).x;
}

float next_fast_random(INOUT(uint) state)
{
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return uint_to_unit_float((word >> 22u) ^ word);
}

// Listing 47-2: keeps one of the lights offered so far, each with probability weight / total, using one number up.
struct Reservoir {
    int emitter;
    float weight;
    float total;
    float xi;
};

Reservoir make_reservoir(float xi)
{
    Reservoir reservoir;
    reservoir.emitter = -1;
    reservoir.weight = 0.0f;
    reservoir.total = 0.0f;
    reservoir.xi = xi;
    return reservoir;
}

// True: the reservoir now holds it. Without branches, and with a single division: it stands in the samplers' innermost
// loops.
bool update_reservoir(INOUT(Reservoir) reservoir, uint emitter, float weight)
{
    float before = reservoir.total;
    reservoir.total += weight;
    float threshold = reservoir.xi * reservoir.total;
    bool offered = weight > 0.0f;
    bool taken = offered && threshold >= before;
    reservoir.emitter = taken ? int(emitter) : reservoir.emitter;
    reservoir.weight = taken ? weight : reservoir.weight;
    // Where in the interval of what it chose the number lies is a number again.
    float rest = (taken ? threshold - before : threshold) / (taken ? weight : before);
    reservoir.xi = offered ? quick_clamp(rest, 0.0f, max_below_one) : reservoir.xi;
    return taken;
}

#endif
