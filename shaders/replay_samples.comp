#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// A-SVGF: one pixel of every stratum is to repeat, with this view's lights, the sample that the last view took of the
// same surface: it takes over the very surface and the random numbers. What then differs is the light (Schied, Peters
// and Dachsbacher 2018, section 4; they project last view's samples forwards, here this view's pixels look backwards).
#include "lib/frame.glsl"
#include "denoise/denoise.glsl"

// Pixels that the old sample may lie off: sideways, and so along the surface at grazing angles.
const float max_pixels_off = 1.5;

// Whether the last view's pixel `there` shows the same surface.
bool shows_same(uint there, PrimarySurface primary)
{
    vec4 old = load_previous_position(there);
    float pixel_width = primary.depth * pixel_spread();
    float cosine = max(dot(primary.surface.geometric_normal, primary.surface.view), 0.05);
    vec3 off = old.xyz - primary.surface.position;
    float max_off = max_pixels_off * pixel_width / cosine;
    vec3 old_normal = unpack_direction(load_previous_normals(there).x);
    return old.w >= 0.0 && dot(off, off) <= max_off * max_off && dot(old_normal, primary.surface.normal) > 0.9;
}

const uint no_pixel = 0xffffffffu;

// The last view's pixel whose sample of the same surface can be repeated, or no_pixel: where the surface was, or where
// pixels share rays, one of the block.
uint find_sample(uint index, PrimarySurface primary)
{
    ivec2 place = nearest_in_last_view(fetch_place(index).xy);
    if (!is_in_last_view(place))
        return no_pixel;
    BounceBlock block = bounce_block_of(uvec2(place));
    uint found = no_pixel;
    ROLLED_FOR (uint i = bounce_block_pixels(); i-- > 0u;) { // its own pixel comes last
        uvec2 pixel = min(pixel_of_block(block, i), frame.previous_size - 1u);
        uint there = pixel.y * frame.previous_size.x + pixel.x;
        uvec2 seed = load_previous_random_seed(there);
        if (is_own_sample(seed) && seed.y >= frame.scene.oldest_repeatable && shows_same(there, primary))
            found = there;
    }
    return found;
}

// A repeated sample tells nothing new of light that has not changed. So where the last view found that next to none
// has, a stratum repeats one in one view of four only: another of 2 x 2 strata each time, whose neighbours count for
// it.
const float min_changed = 0.05;
// Frames that a pixel has been known for once its view, too, has compared repeated samples.
const float min_compared_frames = 1.5;

bool repeats_now(uvec2 stratum, uint number, Moments known)
{
    uint turn = hash_pcg4(uvec4(stratum >> 1u, frame.frame_index, 0x2545f491u)).x >> 30u;
    vec2 changed = changed_share_of_stratum(number);
    return turn == ((stratum.x & 1u) | (stratum.y & 1u) << 1u) || max(changed.x, changed.y) >= min_changed
        || known.frames.x < min_compared_frames;
}

void replay_stratum(uvec2 stratum, uint number)
{
    uvec2 pixel = pixel_of_block(stratum_block(stratum), 0u);
    uint index = pixel_index(min(pixel, frame.size - 1u));
    PrimarySurface primary = load_primary_surface(index);
    uint there = primary.depth < 0.0 || !is_on_screen(pixel) ? no_pixel : find_sample(index, primary);
    if (there == no_pixel) {
        store_replayed(number, vec2(-1.0));
        return;
    }
    Moments known = unpack_moments(load_previous_moments(there));
    bool repeats = repeats_now(stratum, number, known);
    store_replayed(number, repeats ? known.newest : vec2(-1.0));
    if (!repeats)
        return;
    store_position(index, vec4(load_previous_position(there).xyz, primary.depth));
    store_normals(index, load_previous_normals(there));
    store_surface(index, load_previous_surface(there));
    store_random_seed(index, load_previous_random_seed(there));
}

VKPT_RUN_OVER_STRATA(replay_stratum)
