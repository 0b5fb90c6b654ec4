#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// One level of the edge-avoiding a-trous filter (Dammertz et al. 2010), both lobes at once: 3 x 3 taps, `step` pixels apart. Taps
// count by how well they lie on the pixel's plane, by their normal, and by how far their luminance is off in deviations.
#include "lib/frame.glsl"
#include "lib/denoise.glsl"

layout(push_constant, scalar) uniform PushBlock { FilterPush push; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer FilteredBuffer { uvec4 v[]; };

// Luminance differences of this many deviations count for 1 / e.
const float deviations = 1.5;
// Relative to the luminance: what is below cannot be seen, and half floats end there.
const float least_deviation = 2e-3;

// Specular light does not mix where roughness differs by twice the inverse of this.
const float roughness_stop = 16.0;

// Sums over the taps.
struct Sums {
    vec3 light;
    float weight;
    float variance;      // of the sum
    float luminance;
    float luminance2;
};

void add_tap(inout Sums sums, vec3 light, float deviation, float weight)
{
    float l = luminance(light);
    sums.light += light * weight;
    sums.weight += weight;
    float known = max(weight * deviation, 0.0);
    sums.variance += known * known;
    sums.luminance += l * weight;
    sums.luminance2 += l * l * weight;
}

Sums first_tap(vec3 light, float deviation, float weight)
{
    Sums sums = Sums(vec3(0.0), 0.0, 0.0, 0.0, 0.0);
    add_tap(sums, light, deviation, weight);
    return sums;
}

// How far two luminances are apart, in what their deviations allow for; 0 where either is unknown, and every tap on the surface
// counts. Both deviations count: were it the pixel's own alone, the few bright samples of a rare path would be turned away by
// their neighbours, whose history has not met such a path yet, and their light would be lost.
float distance_in_deviations(float l, float deviation, float other, float other_deviation)
{
    if (!is_known(deviation) || !is_known(other_deviation))
        return 0.0;
    float allowed = deviations * sqrt(deviation * deviation + other_deviation * other_deviation);
    return abs(other - l) / (allowed + least_deviation * l + 1e-6);
}

float filtered_deviation(Sums sums, float deviation, float taps)
{
    if (is_known(deviation))
        return sqrt(sums.variance) / sums.weight;
    float mean = sums.luminance / sums.weight;
    return sqrt(max(sums.luminance2 / sums.weight - mean * mean, 0.0) / taps);
}

void filter_pixel(uvec2 pixel, uint index)
{
    FilteredBuffer source = FilteredBuffer(push.source);
    uvec2 guide = load_guide(index);
    uvec4 bits = source.v[index];
    float depth = guide_depth(guide);
    if (depth <= 0.0) {
        FilteredBuffer(push.target).v[index] = bits;
        return;
    }
    vec4 kind = unpackSnorm4x8(guide.x); // normal, material
    vec2 slope = unpackHalf2x16(load_slope(index));
    FilteredLight centre = unpack_filtered(bits);
    float diffuse_luminance = luminance(centre.diffuse), specular_luminance = luminance(centre.specular);
    const float centre_weight = 0.25;
    Sums diffuse = first_tap(centre.diffuse, centre.diffuse_deviation, centre_weight);
    Sums specular = first_tap(centre.specular, centre.specular_deviation, centre_weight);
    float nearest = float(push.step);
    float reach = load_specular_reach(index);
    float specular_fall = 1.0 / (reach * reach);
    [[dont_unroll]] for (uint tap = 0u; tap < 9u; tap++) {
        ivec2 way = ivec2(tap % 3u, tap / 3u) - 1;
        ivec2 place = ivec2(pixel) + way * int(push.step);
        if (tap == 4u || any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, ivec2(frame.size))))
            continue;
        uint there = uint(place.y) * frame.size.x + uint(place.x);
        uvec2 other = load_guide(there);
        vec2 pixels = vec2(way) * nearest;
        float distance = plane_distance(depth, slope, pixels, guide_depth(other));
        vec4 other_kind = unpackSnorm4x8(other.x);
        float cosine = max(dot(kind.xyz, other_kind.xyz), 0.0);
        float cosine2 = cosine * cosine, cosine4 = cosine2 * cosine2, cosine8 = cosine4 * cosine4, cosine16 = cosine8 * cosine8;
        float kernel = way.x == 0 || way.y == 0 ? 0.125 : 0.0625;
        float weight = distance < plane_tolerance(slope, pixels) ? kernel * cosine16 * cosine16 : 0.0;
        // A metal has no diffuse light, and specular light of another colour; other roughnesses reflect other things.
        float difference = abs(kind.w - other_kind.w);
        if (weight < 1e-3 || difference > 0.9)
            continue;
        FilteredLight light = unpack_filtered(source.v[there]);
        float diffuse_distance = distance_in_deviations(
            diffuse_luminance, centre.diffuse_deviation, luminance(light.diffuse), light.diffuse_deviation);
        float specular_distance = distance_in_deviations(specular_luminance, centre.specular_deviation,
                                      luminance(light.specular), light.specular_deviation)
            + dot(pixels, pixels) * specular_fall;
        add_tap(diffuse, light.diffuse, light.diffuse_deviation, weight * exp(-diffuse_distance));
        add_tap(specular, light.specular, light.specular_deviation, weight * exp(-specular_distance) * max(1.0 - roughness_stop * difference, 0.0));
    }
    FilteredLight result;
    result.diffuse = diffuse.light / diffuse.weight;
    result.specular = specular.light / specular.weight;
    result.diffuse_deviation = filtered_deviation(diffuse, centre.diffuse_deviation, 9.0);
    result.specular_deviation = filtered_deviation(specular, centre.specular_deviation, 9.0);
    FilteredBuffer(push.target).v[index] = pack_filtered(result);
}

VKPT_RUN_OVER_PIXELS(filter_pixel)
