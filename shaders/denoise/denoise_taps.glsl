// SPDX-License-Identifier: GPL-2.0-or-later
// What the spatial filter's passes share: a tap of the edge-avoiding a-trous filter (Dammertz et al. 2010), both lobes
// at once. Taps count by how well they lie on the pixel's plane, by their normal, and by how far their luminance is off
// in deviations. Written for CPU drivers, too: no branch, loop or division per tap but one.
#ifndef VKPT_LIB_DENOISE_TAPS
#define VKPT_LIB_DENOISE_TAPS

#include "denoise.glsl"

// Luminance differences of this many deviations count for 1 / e. With 1.5 narrow lights and reflections that are well
// known by now spread over their surroundings, level by level.
const float deviations = 0.9;
// Deviations measured over neighbours, for want of history, count for so many times as much: little is known then, and
// the rare bright samples of a first frame must find others to mix with.
const float measured_slack = 3.0;
// Relative to the luminance: what is below cannot be seen, and half floats end there.
const float min_deviation = 2e-3;
// (1 + luminance_fall)^2 = e
const float luminance_fall = 0.6487;

// Normals farther apart do not mix; nearer ones count for this cosine's 32nd power.
const float min_cosine = 0.8;
// Metals and other materials, which have no diffuse light or specular light of another colour, do not mix.
const float max_material_difference = 0.9;
// Specular light does not mix where roughness differs by twice the inverse of this.
const float roughness_stop = 16.0;

// Sums over the taps.
struct Sums {
    vec3 light;
    float weight;
    float variance; // of the sum
    float square; // mean square of the luminances, times weight
    float known; // weight of the taps whose deviation is known
};

Sums no_taps() { return Sums(vec3(0.0), 0.0, 0.0, 0.0, 0.0); }

// How much the luminances of the taps vary, as an average of `pixels` of them, and with slack. `scale`: 1 over the
// weight.
float measure_variance(Sums sums, float scale, float pixels)
{
    float mean = luminance(sums.light) * scale;
    return quick_max(sums.square * scale - mean * mean, 0.0) * (measured_slack * measured_slack / pixels);
}

void add_tap(inout Sums sums, vec3 light, float l, float deviation, float weight)
{
    float variance = deviation * deviation, weighted = variance * weight;
    sums.light += light * weight;
    sums.weight += weight;
    sums.variance += is_known(deviation) ? weighted * weight : 0.0;
    sums.square += is_known(deviation) ? l * l * weight : weighted;
    sums.known += is_known(deviation) ? weight : 0.0;
}

// Square of the difference of luminances that counts little less than none; any, where it is not known how much they
// vary. Deviations of pixel and tap count: were it the pixel's own alone, the few bright samples of a rare path would
// be turned away by their neighbours, whose history has not met such a path yet, and their light would be lost.
const float any_square = 1e10;
float allowed_square(float deviation)
{
    return is_known(deviation) ? deviations * deviations * deviation * deviation : any_square;
}

float min_variance(float l)
{
    float least = min_deviation * l + 1e-6;
    return least * least;
}

// How much of a tap's own variance counts, for either lobe: all of it up to the luminance whose square is the pixel's
// reach, and beyond that as if the tap were no brighter.
vec2 counted_variance(vec2 reach, vec2 tap)
{
    vec2 divisor = quick_max(tap * tap, reach);
    return reach * divisor.yx * (1.0 / (divisor.x * divisor.y));
}

// That square. A tap's deviation grows with its light, so one that is twenty times brighter would count as alike, and a
// dark line of a pixel's width (the gap under a ledge) would fill up. Where there is no history to tell that the pixel
// is dark, all counts.
const float max_times_brighter_tap = 3.0, any_reach = 1e12;
float tap_reach(float l, bool is_measured)
{
    return is_measured ? any_reach : max_times_brighter_tap * max_times_brighter_tap * l * l + 1e-11;
}

float tap_allowed_square(float deviation, float counted)
{
    return allowed_square(deviation) * (is_known(deviation) ? counted : 1.0);
}

// The pixel that is filtered.
struct Pixel {
    vec3 normal; // of feature_bytes, over 127^2
    float material; // of feature_bytes
    float depth;
    vec2 depth_gradient;
    float specular_fall; // see specular_fall
    float diffuse_luminance, specular_luminance;
    float diffuse_allowed, specular_allowed;
    vec2 reach; // see tap_reach; diffuse, specular
};

// `is_measured`: see is_measured.
Pixel make_pixel(uint index, uvec2 features, FilteredLight light, bvec2 is_measured)
{
    Pixel pixel;
    vec4 kind = feature_bytes(features.x);
    pixel.normal = kind.xyz * (1.0 / (127.0 * 127.0));
    pixel.material = kind.w;
    pixel.depth = feature_depth(features);
    uvec2 reach = load_filter_reach(index);
    pixel.depth_gradient = unpack_upper_halves(reach.x);
    pixel.specular_fall = unpack_upper_halves(reach.y).x;
    pixel.diffuse_luminance = luminance(light.diffuse);
    pixel.specular_luminance = luminance(light.specular);
    pixel.diffuse_allowed = allowed_square(light.diffuse_deviation) + min_variance(pixel.diffuse_luminance);
    pixel.specular_allowed = allowed_square(light.specular_deviation) + min_variance(pixel.specular_luminance);
    pixel.reach
        = vec2(tap_reach(pixel.diffuse_luminance, is_measured.x), tap_reach(pixel.specular_luminance, is_measured.y));
    return pixel;
}

// What a specular tap counts for, `pixels2` being the square of how many pixels it is off.
float specular_fall(Pixel pixel, float pixels2) { return exp(-pixel.specular_fall * pixels2); }

// What is foretold of a tap's depth, as a share of it: by how much the pixel's plane rises on the way, and how far off
// the tap may lie.
struct Way {
    float rise;
    float tolerance;
};
Way make_way(Pixel pixel, vec2 pixels)
{
    return Way(dot(pixel.depth_gradient, pixels), plane_tolerance(pixel.depth_gradient, pixels));
}
Way backwards(Way way) { return Way(-way.rise, way.tolerance); }

// The tap at `there`, which counts for `kernel` if all is alike, `fall` times of it for the specular lobe.
void add_neighbour(inout Sums diffuse, inout Sums specular, Pixel pixel, ScreenBuffer source, uint there, Way way,
    float kernel, float fall)
{
    uvec2 features = load_features(there);
    FilteredLight light = unpack_filtered(load_element(source, there, uvec4(0u)));
    // As plane_distance, without its division.
    float depth = feature_depth(features), off_plane = pixel.depth - depth - depth * way.rise;
    vec4 kind = feature_bytes(features.x);
    float cosine = dot(pixel.normal, kind.xyz), difference = abs(pixel.material - kind.w);
    float cosine2 = cosine * cosine, cosine4 = cosine2 * cosine2, cosine8 = cosine4 * cosine4,
          cosine16 = cosine8 * cosine8;
    bool same
        = abs(off_plane) < depth * way.tolerance && cosine > min_cosine && difference < 127.0 * max_material_difference;
    float weight = same ? kernel * cosine16 * cosine16 : 0.0;
    float alike = 1.0 - roughness_stop / 127.0 * difference;

    // For either lobe 1 / (1 + luminance_fall x^2)^2, with x the difference in what is allowed; a division for both.
    float diffuse_luminance = luminance(light.diffuse), specular_luminance = luminance(light.specular);
    vec2 off = vec2(diffuse_luminance - pixel.diffuse_luminance, specular_luminance - pixel.specular_luminance);
    vec2 counted = counted_variance(pixel.reach, vec2(diffuse_luminance, specular_luminance));
    vec2 allowed = vec2(pixel.diffuse_allowed + tap_allowed_square(light.diffuse_deviation, counted.x),
        pixel.specular_allowed + tap_allowed_square(light.specular_deviation, counted.y));
    vec2 all = allowed + luminance_fall * off * off;
    vec2 share = allowed * all.yx * (1.0 / (all.x * all.y));
    share *= share * weight;
    add_tap(diffuse, light.diffuse, diffuse_luminance, light.diffuse_deviation, share.x);
    add_tap(specular, light.specular, specular_luminance, light.specular_deviation,
        alike > 0.0 ? share.y * fall * alike : 0.0);
}

// The tap at `off` from `pixel`, whose number is `index`; beyond the screen's edge it does not count.
void add_neighbour_at(inout Sums diffuse, inout Sums specular, Pixel centre, ScreenBuffer source, uvec2 pixel,
    uint index, ivec2 off, Way way, float kernel, float fall)
{
    uvec2 place = uvec2(ivec2(pixel) + off);
    bool inside = is_on_screen(place);
    add_neighbour(
        diffuse, specular, centre, source, inside ? pixel_index(place) : index, way, inside ? kernel : 0.0, fall);
}

#endif
