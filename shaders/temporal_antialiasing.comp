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

// Frames that the history is worth at most; where the picture moves, each reading of it blurs, and reflections in it stay behind.
const float most_frames = 10.0, most_moving_frames = 5.0;
const float moving2 = 0.0625; // square of how many pixels a frame that is
// Standard deviations of the neighbourhood that the history may lie off its mean.
const float most_deviations = 1.25;
// A sample counts for exp(-sample_fall d^2) at a distance of d of the result's pixels. Where samples are scarce the least weight
// keeps the nearest one in charge.
const float sample_fall = 2.3;

// Bright pixels count less, or one of them would make a neighbourhood of dark ones flicker. `scale`: about the exposure.
vec3 compress(vec3 radiance, float scale) { return radiance * (scale / (1.0 + scale * luminance(radiance))); }
vec3 expand(vec3 colour, float scale) { return colour / (scale * quick_max(1.0 - luminance(colour), 1e-4)); }

void catmull_rom(float t, out float weights[4])
{
    float t2 = t * t, t3 = t2 * t;
    weights = float[](-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2);
}

uvec2 load_old(ivec2 pixel)
{
    uvec2 at = uvec2(clamp(pixel, ivec2(0), ivec2(frame.resolved_size) - 1));
    return load_previous_resolved(at.y * frame.resolved_size.x + at.x);
}
vec3 old_colour(ivec2 pixel, float scale) { return compress(unpack_light3(load_old(pixel)), scale); }

// At a place whose whole numbers are pixels: bicubic, so that a moving picture does not blur, but for the four corners, which
// count for less than 0.5 % each.
vec3 sample_history(vec2 place, float scale)
{
    vec2 corner = floor(place), part = place - corner;
    ivec2 first = whole_to_int(corner);
    vec3 sum = vec3(0.0);
    if (all(lessThan(abs(part - 0.5), vec2(0.49)))) {
        float across[4], down[4];
        catmull_rom(part.x, across);
        catmull_rom(part.y, down);
        [[unroll]] for (int y = 0; y < 4; y++)
            [[unroll]] for (int x = 0; x < 4; x++)
                if (x == 1 || x == 2 || y == 1 || y == 2)
                    sum += old_colour(first + ivec2(x, y) - 1, scale) * (across[x] * down[y]);
        sum /= 1.0 - (across[0] + across[3]) * (down[0] + down[3]);
        return quick_max(sum, vec3(0.0));
    }
    vec3 upper = mix(old_colour(first, scale), old_colour(first + ivec2(1, 0), scale), part.x);
    vec3 lower = mix(old_colour(first + ivec2(0, 1), scale), old_colour(first + ivec2(1, 1), scale), part.x);
    return mix(upper, lower, part.y);
}

struct Neighbourhood {
    vec3 here; // as sampled near the pixel's middle
    float certainty; // 1: right there
    vec3 mean;
    vec3 deviation;
    float brightest; // luminance
};

// `middle`: of the result's pixel, in rendered pixels; `rendered`: the one it lies in.
Neighbourhood look_around(ivec2 rendered, vec2 middle, float scale)
{
    bool same_size = frame.size == frame.resolved_size;
    vec2 enlargement = vec2(frame.resolved_size) / vec2(frame.size);
    vec3 mean = vec3(0.0), square = vec3(0.0), here = vec3(0.0);
    float weights = 0.0, nearest = 0.0, brightest = 0.0;
    [[unroll]] for (int tap = 0; tap < 9; tap++) {
        ivec2 at = clamp(rendered + ivec2(tap % 3, tap / 3) - 1, ivec2(0), ivec2(frame.size) - 1);
        vec3 colour = compress(unpack_light3(load_composed(uint(at.y) * frame.size.x + uint(at.x))), scale);
        float weight = tap == 4 ? 1.0 : 0.0;
        if (!same_size) {
            vec2 off = (vec2(at) + frame.pixel_offset - middle) * enlargement;
            weight = exp(-sample_fall * dot(off, off));
        }
        here += colour * weight;
        weights += weight;
        nearest = quick_max(nearest, weight);
        mean += colour;
        square += colour * colour;
        brightest = quick_max(brightest, luminance(colour));
    }
    mean *= 1.0 / 9.0;
    return Neighbourhood(here / max(weights, 1e-12), nearest, mean, sqrt(quick_max(square * (1.0 / 9.0) - mean * mean, vec3(0.0))), brightest);
}

void resolve_pixel(uvec2 pixel, uint index)
{
    ExposureBuffer exposure = ExposureBuffer(frame.exposure);
    float scale = exposure.v.valid != 0u ? exposure.v.exposure : 1.0; // of the last view
    vec2 middle = (vec2(pixel) + 0.5) * vec2(frame.size) / vec2(frame.resolved_size);
    uvec2 rendered = min(uvec2(whole_to_int(floor(middle))), frame.size - 1u);
    Neighbourhood now = look_around(ivec2(rendered), middle, scale);
    vec2 place = load_motion(pixel_index(rendered)).xy;
    vec2 way = (place + 0.5) / vec2(frame.previous_size) - (vec2(rendered) + 0.5) / vec2(frame.size);
    place = vec2(pixel) + way * vec2(frame.resolved_size);
    bool on_screen = all(greaterThanEqual(place, vec2(-0.5))) && all(lessThan(place, vec2(frame.resolved_size) - 0.5));
    vec3 result = now.here;
    float frames = now.certainty;
    if ((frame.flags & FRAME_HISTORY) != 0u && on_screen) {
        vec3 reach = now.deviation * most_deviations;
        vec3 old = quick_min(quick_max(sample_history(place, scale), now.mean - reach), now.mean + reach);
        // Beside lamps that lies above all that is there, and where colours end expand() would make a flash of it.
        old *= quick_min(1.0, now.brightest / quick_max(luminance(old), 1e-6));
        frames += unpack_light2(load_old(whole_to_int(floor(place + 0.5))).y).y;
        result = mix(old, now.here, now.certainty / quick_max(frames, 1e-3));
        vec2 moved = place - vec2(pixel);
        frames = quick_min(frames, (dot(moved, moved) < moving2 ? most_frames : most_moving_frames) - 1.0);
    }
    vec3 radiance = quick_min(expand(result, scale), vec3(60000.0)); // 16 bits end soon after
    store_resolved(index, uvec2(pack_light2(radiance.xy), pack_light2(vec2(radiance.z, frames))));
    store_accumulated(index, radiance);
}

VKPT_RUN_OVER(frame.resolved_size, resolve_pixel)
