#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// One level of the gradient's filter: 3 x 3 strata, `step` apart, as far as they lie on the same plane. Sums, not
// averages: only the ratio of difference and greater value counts.
#include "../lib/frame.glsl"
#include "denoise.glsl"

VKPT_PUSH_CONSTANTS

void filter_stratum(uvec2 stratum, uint number)
{
    uvec2 own = load_stratum_place(number), count = stratum_count();
    ivec2 pixel = ivec2(split_halves(own.x));
    float depth = feature_depth(own);
    vec2 depth_gradient = unpack_upper_halves(load_depth_gradient(pixel_index(uvec2(pixel))));
    vec4 sum = vec4(0.0);
    ROLLED_FOR (uint tap = 0u; tap < 9u; tap++) {
        ivec2 way = ivec2(tap % 3u, tap / 3u) - 1;
        ivec2 place = ivec2(stratum) + way * int(push.step);
        if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, ivec2(count))))
            continue;
        uint there = uint(place.y) * count.x + uint(place.x);
        uvec2 other = load_stratum_place(there);
        vec2 pixels = vec2(ivec2(split_halves(other.x)) - pixel);
        if (plane_distance(depth, depth_gradient, pixels, feature_depth(other))
            < plane_tolerance(depth_gradient, pixels))
            sum += load_element(push.source, there, vec4(0.0)) * (way.x == 0 || way.y == 0 ? 0.125 : 0.0625)
                * (tap == 4u ? 2.0 : 1.0);
    }
    store_element(push.target.address, number, sum);
}

VKPT_RUN_OVER_STRATA(filter_stratum)
