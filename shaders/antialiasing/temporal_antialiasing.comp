#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The image over several frames, whose camera rays pass at other places of the pixel: edges become smooth. What the
// last view showed there is limited to what this view's neighbourhood makes likely (Salvi 2016, variance clipping;
// Karis 2014). The result may have more pixels than were rendered: then each of them takes from the samples that happen
// to lie near its middle, and over the frames samples lie everywhere.
#include "../lib/frame.glsl"
#include "../lib/exposure.glsl"
#include "../lib/bsdf.glsl"
#include "../lib/image.glsl"
#include "../lib/packing.glsl"
#include "../lib/reprojection.glsl"

// Frames that the history is worth at most at rest, and where the image moves by moving_pixels a frame or more: there
// each reading of it blurs, and reflections in it stay behind.
const float max_frames = 32.0, max_moving_frames = 5.0;
const float moving_pixels = 0.25;
// By how much a frame makes the average worth more. At rest less than one: newer frames count for more, the last of n
// for 2 / (n + 2), as the denoiser knows more of the light with each, and its first ones spread bright light into dark
// lines.
const float growth_at_rest = 0.5;
// Standard deviations of the neighbourhood that the history may lie off its mean where the image moves. At rest it
// may be all that the neighbourhood shows: of a lamp as small as a pixel most frames show one pixel in nine.
const float max_deviations = 1.25;
// What the edge of a lamp of several rays counts for, in frames: readings of the history take more light from it than
// these rays leave noise.
const float supersampled_worth = 24.0;
// A sample counts for exp(-sample_fall d^2) at a distance of d of the result's pixels. Where samples are scarce the
// least weight keeps the nearest one in charge.
const float sample_fall = 3.0;

// Radiance is averaged as it is where the image stands still, or edges of lamps would lose most of their light, and
// small lamps all but vanish. In motion what is bright counts less in the average, as few frames are averaged and a
// lamp's edge would flicker, and much less between pixels of the history: each reading spreads a lamp by a part of a
// pixel, of which little remains so. `knee`: 1 / the luminance that counts half, in motion these, relative to
// 1 / exposure.
const float moving_knee = 0.01, moving_reading_knee = 3.0;
vec3 compress(vec3 radiance, float knee) { return radiance / (1.0 + knee * luminance(radiance)); }
vec3 expand(vec3 colour, float knee) { return colour / quick_max(1.0 - knee * luminance(colour), 1e-4); }

void catmull_rom(float t, out float weights[4])
{
    float t2 = t * t, t3 = t2 * t;
    weights = float[](
        -0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2);
}

vec3 old_radiance(ivec2 pixel, float knee) { return compress(unpack_light3(load_last_resolved(pixel)), knee); }

// At a place whose whole numbers are pixels, compressed by `knee`: bicubic, so that a moving image does not blur, but
// for the four corners, which count for less than 0.5 % each; and within the range of the nearest four, or there would
// be a dark seam around lamps.
vec3 sample_history(vec2 place, float knee)
{
    vec2 corner = floor(place), part = place - corner;
    ivec2 first = whole_to_int(corner);
    vec3 sum = vec3(0.0), least = vec3(1e9), most = vec3(0.0);
    if (all(lessThan(abs(part - 0.5), vec2(0.49)))) {
        float across[4], down[4];
        catmull_rom(part.x, across);
        catmull_rom(part.y, down);
        UNROLLED_FOR (int y = 0; y < 4; y++)
            UNROLLED_FOR (int x = 0; x < 4; x++)
                if (x == 1 || x == 2 || y == 1 || y == 2) {
                    vec3 old = old_radiance(first + ivec2(x, y) - 1, knee);
                    sum += old * (across[x] * down[y]);
                    if ((x == 1 || x == 2) && (y == 1 || y == 2)) {
                        least = quick_min(least, old);
                        most = quick_max(most, old);
                    }
                }
        sum /= 1.0 - (across[0] + across[3]) * (down[0] + down[3]);
        return quick_min(quick_max(sum, least), most);
    }
    vec3 upper = mix(old_radiance(first, knee), old_radiance(first + ivec2(1, 0), knee), part.x);
    vec3 lower = mix(old_radiance(first + ivec2(0, 1), knee), old_radiance(first + ivec2(1, 1), knee), part.x);
    return mix(upper, lower, part.y);
}

struct Neighbourhood {
    vec3 here; // as sampled near the pixel's middle
    float certainty; // 1: right there
    bool is_supersampled; // the pixel itself
    vec3 mean;
    vec3 deviation;
    vec3 least, most;
    float brightest; // luminance
};

// `middle`: of the result's pixel, in rendered pixels; `rendered`: the one it lies in.
Neighbourhood look_around(ivec2 rendered, vec2 middle, float knee)
{
    bool same_size = frame.size == frame.resolved_size;
    vec2 enlargement = vec2(frame.resolved_size) / vec2(frame.size);
    vec3 mean = vec3(0.0), square = vec3(0.0), here = vec3(0.0), least = vec3(1e9), most = vec3(0.0);
    float weights = 0.0, nearest = 0.0, brightest = 0.0;
    uint marks = 0u;
    UNROLLED_FOR (int tap = 0; tap < 9; tap++) {
        ivec2 at = clamp(rendered + ivec2(tap % 3, tap / 3) - 1, ivec2(0), ivec2(frame.size) - 1);
        uvec2 bits = load_composed(uint(at.y) * frame.size.x + uint(at.x));
        vec3 colour = compress(unpack_light3(bits), knee);
        marks = tap == 4 ? bits.y : marks;
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
        least = quick_min(least, colour);
        most = quick_max(most, colour);
        brightest = quick_max(brightest, luminance(colour));
    }
    mean *= 1.0 / 9.0;
    vec3 deviation = sqrt(quick_max(square * (1.0 / 9.0) - mean * mean, vec3(0.0)));
    return Neighbourhood(
        here / max(weights, 1e-12), nearest, (marks & is_supersampled) != 0u, mean, deviation, least, most, brightest);
}

// At rest a lamp smaller than a pixel is met through some of the camera's places in the pixel only, and in the other
// frames nothing around is as bright as the history rightly is. So `reach` remembers for each of these places whether
// the neighbourhood was dark there, of less than half the luminance that is its most: where it was a period ago and is
// again, the history stays.
struct Reach {
    float most; // luminance
    uint is_dark; // a bit for each place
    uint frames; // since it began anew, up to a period
};

// From the lowest bit: is_dark, frames (5 bits), most (the upper 11 bits of light16_bits).
Reach unpack_reach(uint bits) { return Reach(unpack_light2(bits >> 21u << 5u).x, bits & 0xffffu, bits >> 16u & 31u); }
uint pack_reach(Reach reach)
{
    return reach.is_dark | reach.frames << 16u | (pack_light2(vec2(reach.most, 0.0)) & 0xffe0u) << 16u;
}

// Takes in this frame's. Whether it is as dark as it was to be expected.
bool update_reach(inout Reach reach, float brightest)
{
    uint place = 1u << frame.offset_phase;
    bool is_dark = brightest < 0.5 * reach.most;
    if (brightest > 2.0 * reach.most
        || (reach.frames >= OFFSETS_PER_PIXEL && is_dark != ((reach.is_dark & place) != 0u))) {
        reach = Reach(brightest, 0xffffu & ~place, 1u); // something has changed
        return false;
    }
    bool expected = is_dark && reach.frames >= OFFSETS_PER_PIXEL;
    reach.most = quick_max(reach.most, brightest);
    reach.is_dark = is_dark ? reach.is_dark | place : reach.is_dark & ~place;
    reach.frames = min(reach.frames + 1u, OFFSETS_PER_PIXEL);
    return expected;
}

void resolve_pixel(uvec2 pixel, uint index)
{
    vec2 middle = (vec2(pixel) + 0.5) * vec2(frame.size) / vec2(frame.resolved_size);
    uvec2 rendered = min(uvec2(whole_to_int(floor(middle))), frame.size - 1u);
    vec2 way = way_back(rendered, fetch_place(pixel_index(rendered)).xy);
    vec2 place = vec2(pixel) + way * vec2(frame.resolved_size);
    bool on_screen = all(greaterThanEqual(place, vec2(-0.5))) && all(lessThan(place, vec2(frame.resolved_size) - 0.5));
    float moved = quick_min(length(place - vec2(pixel)) * (1.0 / moving_pixels), 1.0);
    bool is_at_rest = moved < resting_pixels / moving_pixels && frame.size == frame.resolved_size;
    float knee_scale = moved * image_exposure(), knee = moving_knee * knee_scale,
          reading_knee = moving_reading_knee * knee_scale;
    Neighbourhood now = look_around(ivec2(rendered), middle, knee);
    vec3 result = now.here;
    float frames = now.certainty; // that the result is worth
    Reach reach = Reach(now.brightest, 0u, 0u);
    if ((frame.flags & FRAME_HISTORY) != 0u && on_screen) {
        vec3 off = now.deviation * max_deviations;
        vec3 lowest = mix(now.least, quick_max(now.mean - off, vec3(0.0)), moved);
        vec3 highest = mix(now.most, now.mean + off, moved);
        vec3 old = compress(expand(sample_history(place, reading_knee), reading_knee), knee);
        bool is_expected = false;
        if (is_at_rest) {
            reach = unpack_reach(load_reach(index));
            is_expected = update_reach(reach, now.brightest);
        }
        vec3 limited = quick_min(quick_max(old, lowest), highest);
        // Beside lamps that lies above all that is there, and where colours end expand() would make a flash of it.
        limited *= quick_min(1.0, now.brightest / quick_max(luminance(limited), 1e-6));
        float known = unpack_light2(load_last_resolved(whole_to_int(floor(place + 0.5))).y).y;
        if (!is_expected) {
            // What had to be limited that much tells of something else.
            known = luminance(limited) < 0.5 * luminance(old) ? quick_min(known, 1.0) : known;
            old = limited;
        }
        float worth = now.certainty * (now.is_supersampled ? supersampled_worth : 1.0);
        result = mix(old, now.here, worth / quick_max(known + worth, 1e-3));
        frames = known + mix(growth_at_rest, 1.0, moved) * now.certainty;
        frames = quick_min(frames, mix(max_frames, max_moving_frames, moved) - 1.0);
    }
    vec3 radiance = quick_min(expand(result, knee), vec3(60000.0)); // 16 bits end soon after
    store_reach(index, pack_reach(reach));
    store_resolved(index, uvec2(pack_light2(radiance.xy), pack_light2(vec2(radiance.z, frames))));
    store_accumulated(index, vec4(radiance, 0.0));
}

VKPT_RUN_OVER(frame.resolved_size, resolve_pixel)
