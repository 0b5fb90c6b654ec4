#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// One level of the edge-avoiding a-trous filter (Dammertz et al. 2010), both lobes at once: 3 x 3 taps, `step` pixels apart. Taps
// count by how well they lie on the pixel's plane, by their normal, and by how far their luminance is off in deviations.
// Written for CPU drivers, too: no branch, loop or division per tap but one.
#include "lib/frame.glsl"
#include "lib/denoise.glsl"

layout(push_constant, scalar) uniform PushBlock { FilterPush push; };

// Luminance differences of this many deviations count for 1 / e.
const float deviations = 1.5;
// Relative to the luminance: what is below cannot be seen, and half floats end there.
const float least_deviation = 2e-3;
// (1 + luminance_fall)^2 = e
const float luminance_fall = 0.6487;

// Normals farther apart do not mix; nearer ones count for this cosine's 32nd power.
const float least_cosine = 0.8;
// Metals and other materials, which have no diffuse light or specular light of another colour, do not mix.
const float most_material_difference = 0.9;
// Specular light does not mix where roughness differs by twice the inverse of this.
const float roughness_stop = 16.0;

// Sums over the taps.
struct Sums {
    vec3 light;
    float weight;
    float variance; // of the sum
    float square;   // of the luminances
};

void add_tap(inout Sums sums, vec3 light, float l, float deviation, float weight)
{
    float known = is_known(deviation) ? deviation * weight : 0.0, weighted = l * weight;
    sums.light += light * weight;
    sums.weight += weight;
    sums.variance += known * known;
    sums.square += l * weighted;
}

// Square of the difference of luminances that counts little less than none. Deviations of pixel and tap count: were it the
// pixel's own alone, the few bright samples of a rare path would be turned away by their neighbours, whose history has not met
// such a path yet, and their light would be lost.
float allowed_square(float deviation) { return deviations * deviations * deviation * deviation; }

float least_square(float l)
{
    float least = least_deviation * l + 1e-6;
    return least * least;
}

struct Pixel {
    vec3 normal;    // of guide_bytes, over 127^2
    float material; // of guide_bytes
    float depth;
    vec2 slope;     // per step
    float diffuse_luminance, specular_luminance;
    float diffuse_allowed, specular_allowed;
    float specular_fall; // what a specular tap a step away counts for
};

void add_neighbour(inout Sums diffuse, inout Sums specular, Pixel pixel, uint there, vec2 way, float kernel)
{
    uvec2 guide = load_guide(there);
    FilteredLight light = unpack_filtered(load_element(push.source, there, uvec4(0u)));
    // As plane_distance and plane_tolerance, without their division.
    float depth = guide_depth(guide), foretold = depth * (1.0 + dot(pixel.slope, way));
    float tolerance = depth * (0.008 + 0.25 * dot(abs(pixel.slope), abs(way)));
    vec4 kind = guide_bytes(guide.x);
    float cosine = dot(pixel.normal, kind.xyz), difference = abs(pixel.material - kind.w) * (1.0 / 127.0);
    float cosine2 = cosine * cosine, cosine4 = cosine2 * cosine2, cosine8 = cosine4 * cosine4, cosine16 = cosine8 * cosine8;
    bool same = abs(pixel.depth - foretold) < tolerance && cosine > least_cosine && difference < most_material_difference;
    float weight = same ? kernel * cosine16 * cosine16 : 0.0;
    float alike = 1.0 - roughness_stop * difference;

    // For either lobe 1 / (1 + luminance_fall x^2)^2, with x the difference in what is allowed; a division for both.
    float diffuse_luminance = luminance(light.diffuse), specular_luminance = luminance(light.specular);
    vec2 off = vec2(diffuse_luminance - pixel.diffuse_luminance, specular_luminance - pixel.specular_luminance);
    vec2 allowed = vec2(pixel.diffuse_allowed + allowed_square(light.diffuse_deviation),
        pixel.specular_allowed + allowed_square(light.specular_deviation));
    vec2 all = allowed + luminance_fall * off * off;
    vec2 share = allowed * all.yx * (1.0 / (all.x * all.y));
    share *= share * weight;
    float fall = way.x != 0.0 && way.y != 0.0 ? pixel.specular_fall * pixel.specular_fall : pixel.specular_fall;
    add_tap(diffuse, light.diffuse, diffuse_luminance, light.diffuse_deviation, share.x);
    add_tap(specular, light.specular, specular_luminance, light.specular_deviation, alike > 0.0 ? share.y * fall * alike : 0.0);
}

float filtered_deviation(Sums sums, float deviation)
{
    const float taps = 9.0;
    float scale = 1.0 / sums.weight, mean = luminance(sums.light) * scale;
    float measured = max(sums.square * scale - mean * mean, 0.0) / taps;
    return sqrt(is_known(deviation) ? sums.variance * scale * scale : measured);
}

void filter_pixel(uvec2 pixel, uint index)
{
    uvec2 guide = load_guide(index);
    uvec4 bits = load_element(push.source, index, uvec4(0u));
    float depth = guide_depth(guide);
    if (depth <= 0.0) {
        store_element(push.target, index, bits);
        return;
    }
    FilteredLight light = unpack_filtered(bits);
    vec4 kind = guide_bytes(guide.x);
    float far = float(push.step), reach = unpack_moments(load_moments(index)).specular_reach, far_in_reach = far / reach;
    Pixel centre;
    centre.normal = kind.xyz * (1.0 / (127.0 * 127.0));
    centre.material = kind.w;
    centre.depth = depth;
    centre.slope = unpackHalf2x16(load_slope(index)) * far;
    centre.diffuse_luminance = luminance(light.diffuse);
    centre.specular_luminance = luminance(light.specular);
    centre.diffuse_allowed = allowed_square(light.diffuse_deviation) + least_square(centre.diffuse_luminance);
    centre.specular_allowed = allowed_square(light.specular_deviation) + least_square(centre.specular_luminance);
    centre.specular_fall = exp(-far_in_reach * far_in_reach);

    // Taps beyond the edge do not count; they read the pixel at the edge.
    uvec2 last = frame.size - 1u, before = mix(uvec2(0u), pixel - push.step, greaterThanEqual(pixel, uvec2(push.step)));
    uvec2 after = min(pixel + push.step, last);
    uint columns[3] = uint[](before.x, pixel.x, after.x);
    uint rows[3] = uint[](before.y * frame.size.x, index - pixel.x, after.y * frame.size.x);
    float across[3] = float[](pixel.x >= push.step ? 0.25 : 0.0, 0.5, pixel.x + push.step <= last.x ? 0.25 : 0.0);
    float down[3] = float[](pixel.y >= push.step ? 0.25 : 0.0, 0.5, pixel.y + push.step <= last.y ? 0.25 : 0.0);

    Sums diffuse = Sums(vec3(0.0), 0.0, 0.0, 0.0), specular = diffuse;
    add_tap(diffuse, light.diffuse, centre.diffuse_luminance, light.diffuse_deviation, 0.25);
    add_tap(specular, light.specular, centre.specular_luminance, light.specular_deviation, 0.25);
    [[unroll]] for (int y = 0; y < 3; y++)
        [[unroll]] for (int x = 0; x < 3; x++)
            if (x != 1 || y != 1)
                add_neighbour(diffuse, specular, centre, rows[y] + columns[x], vec2(x - 1, y - 1), across[x] * down[y]);
    FilteredLight result;
    result.diffuse = diffuse.light / diffuse.weight;
    result.specular = specular.light / specular.weight;
    result.diffuse_deviation = filtered_deviation(diffuse, light.diffuse_deviation);
    result.specular_deviation = filtered_deviation(specular, light.specular_deviation);
    store_element(push.target, index, pack_filtered(result));
}

VKPT_RUN_OVER_PIXELS(filter_pixel)
