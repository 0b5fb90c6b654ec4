#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// A-SVGF: one pixel of every stratum is to repeat, with this view's lights, the sample that the last view took of the same surface:
// it takes over the very surface and the random numbers. What then differs is the light (Schied, Peters and Dachsbacher 2018,
// section 4; they project last view's samples forwards, here this view's pixels look backwards).
#include "lib/frame.glsl"
#include "lib/denoise.glsl"

// Pixels that the old sample may lie off: sideways, and so along the surface at grazing angles.
const float most_pixels_off = 1.5;

// The last view's pixel that shows the same surface; UINT_MAX: none.
uint find_sample(uint index, PrimarySurface primary)
{
    const uint none = 0xffffffffu;
    vec2 place = floor(load_motion(index).xy + 0.5);
    if (any(lessThan(place, vec2(0.0))) || any(greaterThanEqual(place, vec2(frame.previous_size))))
        return none;
    uvec2 old_pixel = uvec2(whole_to_int(place));
    uint there = old_pixel.y * frame.previous_size.x + old_pixel.x;
    vec4 old = load_previous_position(there);
    float pixel_width = primary.depth * 2.0 * length(frame.camera.right) / float(frame.size.x);
    float cosine = max(dot(primary.surface.geometric_normal, primary.surface.view), 0.05);
    vec3 off = old.xyz - primary.surface.position;
    if (old.w < 0.0 || dot(off, off) > pow(most_pixels_off * pixel_width / cosine, 2.0))
        return none;
    vec3 old_normal = unpack_direction(load_previous_normals(there).x);
    return dot(old_normal, primary.surface.normal) > 0.9 ? there : none;
}

void replay_stratum(uvec2 stratum, uint number)
{
    uvec2 pixel = stratum_pixel(stratum);
    uint index = pixel.y * frame.size.x + pixel.x;
    PrimarySurface primary = load_primary_surface(index);
    uint there = primary.depth < 0.0 ? 0xffffffffu : find_sample(index, primary);
    uvec2 seed = load_previous_random_seed(there == 0xffffffffu ? index : there);
    if (there == 0xffffffffu || seed.y < frame.scene.oldest_repeatable) {
        store_replayed(number, vec2(-1.0));
        return;
    }
    store_replayed(number,
        vec2(luminance(load_previous_diffuse_light(there)), luminance(load_previous_specular_light(there))));
    store_position(index, vec4(load_previous_position(there).xyz, primary.depth));
    store_normals(index, load_previous_normals(there));
    store_surface(index, load_previous_surface(there));
    store_random_seed(index, seed);
}

VKPT_RUN_OVER_STRATA(replay_stratum)
