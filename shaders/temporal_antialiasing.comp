#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The picture over several frames, whose camera rays pass at other places of the pixel: edges become smooth. What the last view
// showed there is limited to what this view's neighbourhood makes likely (Salvi 2016, variance clipping; Karis 2014).
#include "lib/frame.glsl"
#include "lib/bsdf.glsl"
#include "lib/packing.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ExposureBuffer { ExposureState v; };

const float newest_share = 0.1;
// Standard deviations of the neighbourhood that the history may lie off its mean.
const float most_deviations = 1.25;

// Bright pixels count less, or one of them would make a neighbourhood of dark ones flicker. `scale`: about the exposure.
vec3 compress(vec3 radiance, float scale) { return radiance * (scale / (1.0 + scale * luminance(radiance))); }
vec3 expand(vec3 colour, float scale) { return colour / (scale * max(1.0 - luminance(colour), 1e-4)); }

vec4 catmull_rom(float t)
{
    float t2 = t * t, t3 = t2 * t;
    return vec4(-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2);
}

vec3 old_colour(vec2 pixel, float scale)
{
    return compress(unpack_half3(load_previous_resolved(uint(pixel.y) * frame.size.x + uint(pixel.x))), scale);
}

// At a place whose whole numbers are pixels: bicubic, so that a moving picture does not blur.
vec3 sample_history(vec2 place, float scale)
{
    vec2 corner = floor(place), part = place - corner;
    if (all(lessThan(abs(part - 0.5), vec2(0.49)))) {
        vec4 wx = catmull_rom(part.x), wy = catmull_rom(part.y);
        vec3 sum = vec3(0.0);
        [[dont_unroll]] for (uint tap = 0u; tap < 16u; tap++) {
            vec2 at = clamp(corner + vec2(tap & 3u, tap >> 2u) - 1.0, vec2(0.0), vec2(frame.size - 1u));
            sum += old_colour(at, scale) * (wx[tap & 3u] * wy[tap >> 2u]);
        }
        return max(sum, vec3(0.0));
    }
    vec3 sum = vec3(0.0);
    [[dont_unroll]] for (uint tap = 0u; tap < 4u; tap++) {
        vec2 offset = vec2(tap & 1u, tap >> 1u), shares = mix(1.0 - part, part, offset);
        vec2 at = clamp(corner + offset, vec2(0.0), vec2(frame.size - 1u));
        sum += old_colour(at, scale) * (shares.x * shares.y);
    }
    return sum;
}

void resolve_pixel(uvec2 pixel, uint index)
{
    ExposureBuffer exposure = ExposureBuffer(frame.exposure);
    float scale = exposure.v.valid != 0u ? exposure.v.exposure : 1.0; // of the last view
    vec3 mean = vec3(0.0), square = vec3(0.0), here = vec3(0.0);
    [[dont_unroll]] for (uint tap = 0u; tap < 9u; tap++) {
        ivec2 at = clamp(ivec2(pixel) + ivec2(tap % 3u, tap / 3u) - 1, ivec2(0), ivec2(frame.size) - 1);
        vec3 colour = compress(load_radiance(uint(at.y) * frame.size.x + uint(at.x)), scale);
        if (tap == 4u)
            here = colour;
        mean += colour;
        square += colour * colour;
    }
    vec3 result = here;
    vec2 place = load_motion(index).xy;
    bool on_screen = all(greaterThanEqual(place, vec2(-0.5))) && all(lessThan(place, vec2(frame.size) - 0.5));
    if ((frame.flags & FRAME_HISTORY) != 0u && on_screen) {
        mean /= 9.0;
        vec3 reach = sqrt(max(square / 9.0 - mean * mean, vec3(0.0))) * most_deviations;
        vec3 old = clamp(sample_history(place, scale), mean - reach, mean + reach);
        result = mix(old, here, newest_share);
    }
    vec3 radiance = min(expand(result, scale), 60000.0); // half floats end soon after
    store_resolved(index, pack_half3(radiance));
    store_accumulated(index, radiance);
}

VKPT_RUN_OVER_PIXELS(resolve_pixel)
