// SPDX-License-Identifier: GPL-2.0-or-later
// Contrast between neighbouring pixels that averaging over frames, and enlarging, have taken away: as much as leaves
// every channel between black and white (the limits of AMD's FidelityFX RCAS, 2021), so that edges get no halo and
// noise no more than its share.
#ifndef VKPT_LIB_SHARPEN
#define VKPT_LIB_SHARPEN

#include "device/quick_floats.glsl"

// Between black and white, in steps that look alike; `exposed`: radiance times exposure.
vec3 to_shades(vec3 exposed) { return sqrt(exposed / (1.0 + exposed)); }
vec3 from_shades(vec3 shades)
{
    vec3 squares = quick_min(shades * shades, vec3(0.9999));
    return squares / (1.0 - squares);
}

// All in shades: a pixel and its four neighbours; `strength` from 0 to 1.
vec3 sharpen(vec3 middle, vec3 left, vec3 right, vec3 above, vec3 below, float strength)
{
    const float most = 0.1875; // of each neighbour that is taken away; at 0.25 nothing would be left to divide by
    vec3 least = quick_min(quick_min(left, right), quick_min(above, below));
    vec3 greatest = quick_max(quick_max(left, right), quick_max(above, below));
    // Taking away more would make the result negative, or more than white.
    vec3 until_black = quick_min(least, middle) / quick_max(4.0 * greatest, vec3(1e-4));
    vec3 until_white = (1.0 - quick_max(greatest, middle)) / quick_max(4.0 - 4.0 * least, vec3(1e-4));
    vec3 limits = quick_min(until_black, until_white);
    float share = quick_min(quick_min(quick_min(limits.x, limits.y), limits.z), most) * strength;
    return quick_max(middle - share * (left + right + above + below), vec3(0.0)) / (1.0 - 4.0 * share);
}

#endif
