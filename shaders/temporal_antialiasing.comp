#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The picture over several frames, whose camera rays pass at other places of the pixel: edges become smooth. What the last view
// showed there is limited to what this view's neighbourhood makes likely (Salvi 2016, variance clipping; Karis 2014). The result
// may have more pixels than were rendered: then each of them takes from the samples that happen to lie near its middle, and over
// the frames samples lie everywhere.
#include "lib/frame.glsl"
#include "lib/bsdf.glsl"
#include "lib/packing.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ExposureBuffer { ExposureState v; };

// Frames that the history is worth at most.
const float most_frames = 10.0;
// Standard deviations of the neighbourhood that the history may lie off its mean.
const float most_deviations = 1.25;
// A sample counts for exp(-sample_fall d^2) at a distance of d of the result's pixels. Where samples are scarce the least weight
// keeps the nearest one in charge.
const float sample_fall = 2.3;

// Bright pixels count less, or one of them would make a neighbourhood of dark ones flicker. `scale`: about the exposure.
vec3 compress(vec3 radiance, float scale) { return radiance * (scale / (1.0 + scale * luminance(radiance))); }
vec3 expand(vec3 colour, float scale) { return colour / (scale * max(1.0 - luminance(colour), 1e-4)); }

vec4 catmull_rom(float t)
{
    float t2 = t * t, t3 = t2 * t;
    return vec4(-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2);
}

uvec2 load_old(vec2 pixel) { return load_previous_resolved(uint(pixel.y) * frame.resolved_size.x + uint(pixel.x)); }
vec3 old_colour(vec2 pixel, float scale) { return compress(unpack_light3(load_old(pixel)), scale); }

// At a place whose whole numbers are pixels: bicubic, so that a moving picture does not blur.
vec3 sample_history(vec2 place, float scale)
{
    vec2 corner = floor(place), part = place - corner, last = vec2(frame.resolved_size - 1u);
    vec3 sum = vec3(0.0);
    if (all(lessThan(abs(part - 0.5), vec2(0.49)))) {
        vec4 wx = catmull_rom(part.x), wy = catmull_rom(part.y);
        [[dont_unroll]] for (uint tap = 0u; tap < 16u; tap++) {
            vec2 at = clamp(corner + vec2(tap & 3u, tap >> 2u) - 1.0, vec2(0.0), last);
            sum += old_colour(at, scale) * (wx[tap & 3u] * wy[tap >> 2u]);
        }
        return max(sum, vec3(0.0));
    }
    [[dont_unroll]] for (uint tap = 0u; tap < 4u; tap++) {
        vec2 offset = vec2(tap & 1u, tap >> 1u), shares = mix(1.0 - part, part, offset);
        sum += old_colour(clamp(corner + offset, vec2(0.0), last), scale) * (shares.x * shares.y);
    }
    return sum;
}

struct Neighbourhood {
    vec3 here; // as sampled near the pixel's middle
    float certainty; // 1: right there
    vec3 mean;
    vec3 deviation;
};

// `middle`: of the result's pixel, in rendered pixels.
Neighbourhood look_around(vec2 middle, float scale)
{
    bool same_size = frame.size == frame.resolved_size;
    vec2 enlargement = vec2(frame.resolved_size) / vec2(frame.size);
    vec3 mean = vec3(0.0), square = vec3(0.0), here = vec3(0.0);
    float weights = 0.0, nearest = 0.0;
    [[dont_unroll]] for (uint tap = 0u; tap < 9u; tap++) {
        ivec2 at = clamp(ivec2(middle) + ivec2(tap % 3u, tap / 3u) - 1, ivec2(0), ivec2(frame.size) - 1);
        vec3 colour = compress(load_radiance(uint(at.y) * frame.size.x + uint(at.x)), scale);
        vec2 off = (vec2(at) + frame.pixel_offset - middle) * enlargement;
        float weight = same_size ? (tap == 4u ? 1.0 : 0.0) : exp(-sample_fall * dot(off, off));
        here += colour * weight;
        weights += weight;
        nearest = max(nearest, weight);
        mean += colour;
        square += colour * colour;
    }
    mean /= 9.0;
    return Neighbourhood(here / max(weights, 1e-12), nearest, mean, sqrt(max(square / 9.0 - mean * mean, vec3(0.0))));
}

void resolve_pixel(uvec2 pixel, uint index)
{
    ExposureBuffer exposure = ExposureBuffer(frame.exposure);
    float scale = exposure.v.valid != 0u ? exposure.v.exposure : 1.0; // of the last view
    vec2 middle = (vec2(pixel) + 0.5) * vec2(frame.size) / vec2(frame.resolved_size);
    Neighbourhood now = look_around(middle, scale);
    uvec2 rendered = min(uvec2(middle), frame.size - 1u);
    vec2 place = load_motion(rendered.y * frame.size.x + rendered.x).xy;
    vec2 way = (place + 0.5) / vec2(frame.previous_size) - (vec2(rendered) + 0.5) / vec2(frame.size);
    place = vec2(pixel) + way * vec2(frame.resolved_size);
    bool on_screen = all(greaterThanEqual(place, vec2(-0.5))) && all(lessThan(place, vec2(frame.resolved_size) - 0.5));
    vec3 result = now.here;
    float frames = now.certainty;
    if ((frame.flags & FRAME_HISTORY) != 0u && on_screen) {
        vec3 reach = now.deviation * most_deviations;
        vec3 old = clamp(sample_history(place, scale), now.mean - reach, now.mean + reach);
        frames += unpack_light2(load_old(floor(place + 0.5)).y).y;
        result = mix(old, now.here, now.certainty / max(frames, 1e-3));
        frames = min(frames, most_frames - 1.0);
    }
    vec3 radiance = min(expand(result, scale), 60000.0); // 16 bits end soon after
    store_resolved(index, uvec2(pack_light2(radiance.xy), pack_light2(vec2(radiance.z, frames))));
    store_accumulated(index, radiance);
}

VKPT_RUN_OVER(frame.resolved_size, resolve_pixel)
