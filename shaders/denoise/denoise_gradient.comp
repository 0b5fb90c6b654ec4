#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// How much the repeated samples have changed since the last view: the difference, and the greater of the two, for
// either lobe.
#include "../lib/frame.glsl"
#include "denoise.glsl"

void compare_stratum(uvec2 stratum, uint number)
{
    vec2 before = load_replayed(number);
    vec4 gradient = vec4(0.0);
    uvec2 pixel = stratum_pixel(stratum);
    uint index = pixel_index(pixel);
    if (before.x >= 0.0 && is_own_sample(load_random_seed(index))) {
        vec2 now = unpack_light2(pack_light2(luminances(fetch_reflected_light(index)))); // as `before` was kept
        vec2 change = now - before, greater = max(now, before);
        gradient = vec4(change.x, greater.x, change.y, greater.y);
        if (any(isnan(gradient)) || any(isinf(gradient)))
            gradient = vec4(0.0);
    }
    store_gradient_a(number, gradient);
    store_stratum_place(number, uvec2(join_halves(pixel), load_features(index).y));
}

VKPT_RUN_OVER_STRATA(compare_stratum)
