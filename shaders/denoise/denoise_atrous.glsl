// SPDX-License-Identifier: GPL-2.0-or-later
// A further level of the spatial filter: four taps, a quarter turn apart. The levels' ways grow and turn, so that their
// taps together leave no pattern; along either axis each level spreads light as far as 3 x 3 taps of 1/4, 1/2 and 1/4
// would do at 0.8 of its way.
#ifndef VKPT_LIB_DENOISE_SPREAD
#define VKPT_LIB_DENOISE_SPREAD

#include "denoise_taps.glsl"

VKPT_PUSH_CONSTANTS

const float centre_weight = 1.0 / 3.0, tap_weight = 1.0 / 6.0;

// Where too few frames tell how much the light varies, the pixels of this level and the first do, which are worth so
// many in the average.
const float measured_pixels = 32.0;
float spread_deviation(Sums sums, float scale, float deviation, bool is_measured)
{
    float root
        = sqrt(is_known(deviation) ? sums.variance * scale * scale : measure_variance(sums, scale, measured_pixels));
    return is_measured ? -root : root;
}

// `bits`: of the pixel, in the level's source.
FilteredLight filter_atrous(uvec2 pixel, uint index, uvec2 features, uvec4 bits)
{
    FilteredLight light = unpack_filtered(bits);
    bvec2 measured = is_measured(bits);
    Pixel centre = make_pixel(index, features, light, measured);
    vec2 along = vec2(push.way), across = vec2(-along.y, along.x);
    Way way_along = make_way(centre, along), way_across = make_way(centre, across);
    float fall = specular_fall(centre, dot(along, along));
    Sums diffuse = no_taps(), specular = diffuse;
    add_tap(diffuse, light.diffuse, centre.diffuse_luminance, light.diffuse_deviation, centre_weight);
    add_tap(specular, light.specular, centre.specular_luminance, light.specular_deviation, centre_weight);
    ivec2 places[4] = ivec2[](push.way, -push.way, ivec2(-push.way.y, push.way.x), ivec2(push.way.y, -push.way.x));
    Way ways[4] = Way[](way_along, backwards(way_along), way_across, backwards(way_across));
    UNROLLED_FOR (int tap = 0; tap < 4; tap++)
        add_neighbour_at(
            diffuse, specular, centre, push.source, pixel, index, places[tap], ways[tap], tap_weight, fall);
    float diffuse_scale = 1.0 / diffuse.weight, specular_scale = 1.0 / specular.weight;
    return FilteredLight(diffuse.light * diffuse_scale,
        spread_deviation(diffuse, diffuse_scale, light.diffuse_deviation, measured.x), specular.light * specular_scale,
        spread_deviation(specular, specular_scale, light.specular_deviation, measured.y));
}

// Between the first level and the last one.
void spread_pixel(uvec2 pixel, uint index)
{
    uvec2 features = load_features(index);
    uvec4 bits = load_element(push.source, index, uvec4(0u));
    if (feature_depth(features) > 0.0)
        bits = pack_filtered(filter_atrous(pixel, index, features, bits));
    store_element(push.target.address, index, bits);
}

#endif
