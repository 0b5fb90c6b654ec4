// SPDX-License-Identifier: GPL-2.0-or-later
// Random numbers as a pure function of pixel, frame, seed and dimension: a pixel can be replayed in a later frame, and
// every decision of a path has its own dimension, so that a decision made or not made leaves the others' numbers alone.
#ifndef VKPT_LIB_RANDOM
#define VKPT_LIB_RANDOM

#include "../shared/functions.h"

struct Random {
    uvec2 pixel;
    uint frame;
    uint seed;
    uint dimension; // of the next number
};

// Dimensions are handed out in blocks: one block for each bounce of a path.
const uint random_dimensions_per_bounce = 16u;

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
float uint_to_unit_float(uint bits)
{
    return float(bits >> 8u) * 5.9604644775390625e-8f;
}

// The number of one dimension. Every number of the renderer comes through here: the place to look up blue noise instead.
float random_dimension(uvec2 pixel, uint frame, uint seed, uint dimension)
{
    uvec4 words = hash_pcg4(uvec4(pixel.x | (pixel.y << 16u), frame, seed, dimension));
    return uint_to_unit_float(words.x);
}

Random make_random(uvec2 pixel, uint frame, uint seed)
{
    Random random;
    random.pixel = pixel;
    random.frame = frame;
    random.seed = seed;
    random.dimension = 0u;
    return random;
}

// The generator at the start of a bounce's block of dimensions.
Random random_for_bounce(Random random, uint bounce)
{
    random.dimension = bounce * random_dimensions_per_bounce;
    return random;
}

// A generator independent of `random` (another seed), for what must not share numbers with it.
Random random_stream(Random random, uint stream)
{
    random.seed = hash_pcg4(uvec4(random.seed, stream, 0x9e3779b9u, 0x85ebca6bu)).x;
    random.dimension = 0u;
    return random;
}

float next_float(INOUT(Random) random)
{
    float value = random_dimension(random.pixel, random.frame, random.seed, random.dimension);
    random.dimension += 1u;
    return value;
}

vec2 next_vec2(INOUT(Random) random)
{
    float x = next_float(random);
    float y = next_float(random);
    return vec2(x, y);
}

#endif
