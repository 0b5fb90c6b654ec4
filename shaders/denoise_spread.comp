#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// A further level of the spatial filter: four taps, a quarter turn apart. The levels' ways grow and turn, so that their taps together
// leave no pattern; along either axis each level spreads light as far as 3 x 3 taps of 1/4, 1/2 and 1/4 would do at 0.8 of its way.
#include "lib/frame.glsl"
#include "lib/denoise_taps.glsl"

layout(push_constant, scalar) uniform PushBlock { SpreadPush push; };

const float centre_weight = 1.0 / 3.0, tap_weight = 1.0 / 6.0;

// Where too few frames tell how much the light varies, the pixels of this level and the first do, which are worth so many in the average.
const float measured_pixels = 32.0;
float spread_deviation(Sums sums, float scale, float deviation)
{
    return sqrt(is_known(deviation) ? sums.variance * scale * scale : measure_variance(sums, scale, measured_pixels));
}

void spread_pixel(uvec2 pixel, uint index)
{
    uvec2 guide = load_guide(index);
    uvec4 bits = load_element(push.source, index, uvec4(0u));
    if (guide_depth(guide) <= 0.0) {
        store_element(push.target.address, index, bits);
        return;
    }
    FilteredLight light = unpack_filtered(bits);
    Pixel centre = make_pixel(index, guide, light);
    float fall = specular_fall(length(vec2(push.way)), unpack_moments(load_moments(index)).specular_reach);
    Sums diffuse = no_taps(), specular = diffuse;
    add_tap(diffuse, light.diffuse, centre.diffuse_luminance, light.diffuse_deviation, centre_weight);
    add_tap(specular, light.specular, centre.specular_luminance, light.specular_deviation, centre_weight);
    ivec2 ways[4] = ivec2[](push.way, -push.way, ivec2(-push.way.y, push.way.x), ivec2(push.way.y, -push.way.x));
    [[unroll]] for (int tap = 0; tap < 4; tap++) {
        ivec2 place = ivec2(pixel) + ways[tap];
        bool inside = is_on_screen(uvec2(place));
        uint there = inside ? pixel_index(uvec2(place)) : index;
        add_neighbour(diffuse, specular, centre, push.source, there, vec2(ways[tap]), inside ? tap_weight : 0.0, fall);
    }
    float diffuse_scale = 1.0 / diffuse.weight, specular_scale = 1.0 / specular.weight;
    FilteredLight result = FilteredLight(diffuse.light * diffuse_scale, spread_deviation(diffuse, diffuse_scale, light.diffuse_deviation),
        specular.light * specular_scale, spread_deviation(specular, specular_scale, light.specular_deviation));
    store_element(push.target.address, index, pack_filtered(result));
}

VKPT_RUN_OVER_PIXELS(spread_pixel)
