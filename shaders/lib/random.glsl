// SPDX-License-Identifier: GPL-2.0-or-later
// Random numbers as a pure function of pixel, frame, seed and dimension: a pixel can be replayed in a later frame, and
// every decision of a path has its own dimension, so that a decision made or not made leaves the others' numbers alone.
// Two kinds (pt_noise): white numbers are a hash; blue ones come from spatiotemporal masks, so that the errors of
// neighbouring pixels and frames differ and cancel where the eye or a filter averages them. docs/light-sampling.md.
#ifndef VKPT_LIB_RANDOM
#define VKPT_LIB_RANDOM

#include "../shared/functions.h"
#include "../shared/cvars.h"
#include "../shared/noise.h"

VKPT_BUFFER(BlueNoiseBuffer, uint, 4);

struct Random {
    uvec2 pixel;
    uint frame;
    uint seed;
    uint dimension; // of the next number
    int kind; // NOISE_*
    // Read where kind is NOISE_BLUE:
    BlueNoiseBuffer masks;
    uint period_key;
};

// Dimensions are handed out in blocks: one block for each bounce of a path.
const uint random_dimensions_per_bounce = 16u;
// Deeper in a path a number acts through so many others that its order over the pixels is lost, and white numbers need
// no memory: blue are those of the camera path (block 0), of direct light (1) and of the first bounce (2).
const uint blue_blocks = 3u;

// Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 2020: the four-word PCG hash.
uvec4 hash_pcg4(uvec4 words)
{
    words = words * 1664525u + 1013904223u;
    words.x += words.y * words.w;
    words.y += words.z * words.x;
    words.z += words.x * words.y;
    words.w += words.y * words.z;
    words = words ^ (words >> 16u);
    words.x += words.y * words.w;
    words.y += words.z * words.x;
    words.z += words.x * words.y;
    words.w += words.y * words.z;
    return words;
}

// In [0, 1): the 24 bits that a float holds exactly, so 1 never appears.
float uint_to_unit_float(uint bits) { return float(int(bits >> 8u)) * 5.9604644775390625e-8f; }

float white_dimension(uvec2 pixel, uint frame, uint seed, uint dimension)
{
    uvec4 words = hash_pcg4(uvec4(pixel.x | (pixel.y << 16u), frame, seed, dimension));
    return uint_to_unit_float(words.x);
}

// One word's bits mixed thoroughly: two multiplications between xor-shifts (constants: Wellons 2018, "lowbias32").
uint hash_word(uint word)
{
    word = (word ^ (word >> 16u)) * 0x7feb352du;
    word = (word ^ (word >> 15u)) * 0x846ca68bu;
    return word ^ (word >> 16u);
}

// What the shifts of all masks in a frame's period are hashed from. To be worked out once: CPU drivers leave in a loop
// what does not depend on it.
uint blue_period_key(uint frame, uint seed)
{
    return hash_pcg4(uvec4(0x6a09e667u, frame / BLUE_NOISE_SLICES, seed, 0u)).x;
}

// A mask runs through its slices with the frames. Each period of a dimension shifts it anew, by a hash: over the
// periods a pixel sees every value of the mask equally often, independently in each dimension, so the mean of any
// estimate is that under white numbers. The hash also gives the bits below the mask's 16.
float blue_dimension(BlueNoiseBuffer masks, uvec2 pixel, uint frame, uint period_key, uint dimension)
{
    uint hash = hash_word(period_key + dimension * 0x9e3779b9u);
    uint x = (pixel.x + (hash >> 16u)) % BLUE_NOISE_SIZE;
    uint y = (pixel.y + (hash >> 22u)) % BLUE_NOISE_SIZE;
    uint slice = frame % BLUE_NOISE_SLICES, mask = dimension % BLUE_NOISE_MASKS;
    uint voxel = ((mask / 2u * BLUE_NOISE_SLICES + slice) * BLUE_NOISE_SIZE + y) * BLUE_NOISE_SIZE + x;
    uint value = (masks.v[voxel] >> (mask % 2u * 16u)) & 0xffffu;
    return uint_to_unit_float((value << 16u) | (hash & 0xffffu));
}

// The number of one dimension. Every number of the renderer comes through here.
float random_dimension(Random random, uint dimension)
{
    if (random.kind == NOISE_BLUE)
        return blue_dimension(random.masks, random.pixel, random.frame, random.period_key, dimension);
    return white_dimension(random.pixel, random.frame, random.seed, dimension);
}

// White numbers.
Random make_random(uvec2 pixel, uint frame, uint seed)
{
    Random random;
    random.kind = NOISE_WHITE;
    random.pixel = pixel;
    random.frame = frame;
    random.seed = seed;
    random.dimension = 0u;
    random.period_key = 0u;
    return random;
}

Random make_blue_random(BlueNoiseBuffer masks, uvec2 pixel, uint frame, uint seed)
{
    Random random = make_random(pixel, frame, seed);
    random.kind = NOISE_BLUE;
    random.masks = masks;
    random.period_key = blue_period_key(frame, seed);
    return random;
}

// The generator at the start of a bounce's block of dimensions.
Random random_for_bounce(Random random, uint bounce)
{
    random.dimension = bounce * random_dimensions_per_bounce;
    if (bounce >= blue_blocks)
        random.kind = NOISE_WHITE;
    return random;
}

// A generator independent of `random` (another seed), for what must not share numbers with it.
Random random_stream(Random random, uint stream)
{
    random.seed = hash_pcg4(uvec4(random.seed, stream, 0x9e3779b9u, 0x85ebca6bu)).x;
    random.dimension = 0u;
    if (random.kind == NOISE_BLUE)
        random.period_key = blue_period_key(random.frame, random.seed);
    return random;
}

float next_float(INOUT(Random) random)
{
    float value = random_dimension(random, random.dimension);
    random.dimension += 1u;
    return value;
}

// A loop: a number's code is long.
vec3 next_vec3(INOUT(Random) random)
{
    vec3 result = vec3(0.0f);
    ROLLED_FOR (int i = 0; i < 3; i++)
        result[i] = next_float(random);
    return result;
}

vec2 next_vec2(INOUT(Random) random)
{
    vec2 result = vec2(0.0f);
    ROLLED_FOR (int i = 0; i < 2; i++)
        result[i] = next_float(random);
    return result;
}

// Place `number` of an additive recurrence in the unit square that begins at `first` (Roberts 2018, R2).
vec2 recurrent_place(vec2 first, uint number)
{
    return fract(first + float(number) * vec2(0.7548776662f, 0.5698402910f));
}

#endif
