#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The first level of the spatial filter: 3 x 3 pixels.
#include "../lib/frame.glsl"
#include "denoise_taps.glsl"

// As FilteredLight has it. What is unknown stays so until the next level, but for pixels beside some with more history,
// as anti-aliasing makes them at every edge: the next level would blur those.
float filtered_deviation(Sums sums, float scale, float deviation)
{
    const float min_known = 0.03, pixels = 9.0;
    bool beside_known = sums.known * scale > min_known;
    float measured = sqrt(beside_known ? measure_variance(sums, scale, pixels) : sums.square * scale);
    return is_known(deviation) ? sqrt(sums.variance) * scale : (beside_known ? measured : -measured);
}

// Frames of history from which on less of this level is shown than it finds: that much / frames. The average alone
// already has little noise then.
const float fully_filtered_frames = 6.0;
float shown_share(float frames) { return quick_min(fully_filtered_frames / quick_max(frames, 1.0), 1.0); }

// How much of this level becomes the next view's history. What it takes from bright neighbours comes anew with every
// frame, so shadows of a pixel's width fill up. The first frames' level hardly asks what is alike, and would stay in
// the history for long: of it only so much is kept that places which rare light has not met yet are not wholly dark,
// as other pixels' light would then be turned away (tap_reach).
const float first_frames = 8.0, first_kept_share = 0.2, fully_kept_frames = 5.0;
float kept_share(float frames)
{
    // 0.01: frames are kept in sevenths, which are rounded
    return frames < first_frames - 0.01 ? first_kept_share : quick_min(fully_kept_frames / frames, 1.0);
}

// Between the pixel's own average and what the level found for either lobe. Where the deviation is unknown it is so in
// both.
FilteredLight mix_light(FilteredLight own, FilteredLight level, vec2 share)
{
    return FilteredLight(mix(own.diffuse, level.diffuse, share.x),
        mix(own.diffuse_deviation, level.diffuse_deviation, share.x), mix(own.specular, level.specular, share.y),
        mix(own.specular_deviation, level.specular_deviation, share.y));
}

// Slices of a pixel or two in width that a movement has just uncovered: hardly any of the 3 x 3 pixels is of the same
// surface, and few taps of the levels that follow will be, since their ways turn. So those along the axes that are
// count as well, as long as there is next to no history.
const float new_frames = 2.0, few_alike = 0.6;
const int farther[3] = int[](2, 3, 5);
void add_farther_taps(inout Sums diffuse, inout Sums specular, Pixel centre, uvec2 pixel, uint index)
{
    UNROLLED_FOR (int i = 0; i < 3; i++)
        ROLLED_FOR (int side = 0; side < 4; side++) {
            int way = side < 2 ? farther[i] : -farther[i];
            ivec2 off = (side & 1) == 0 ? ivec2(way, 0) : ivec2(0, way);
            add_neighbour_at(diffuse, specular, centre, frame.screen.filter_a, pixel, index, off,
                make_way(centre, vec2(off)), 0.125, specular_fall(centre, float(way * way)));
        }
}

void filter_pixel(uvec2 pixel, uint index)
{
    uvec2 features = load_features(index);
    uvec4 bits = load_filter_a(index);
    if (feature_depth(features) <= 0.0) {
        store_filter_b(index, bits);
        store_filtered(index, bits);
        return;
    }
    FilteredLight light = unpack_filtered(bits);
    Pixel centre = make_pixel(index, features, light, is_measured(bits));
    float fall = specular_fall(centre, 1.0);

    // Taps beyond the edge do not count; they read the pixel at the edge.
    uvec2 last = frame.size - 1u, before = pixel - min(pixel, uvec2(1u)), after = min(pixel + 1u, last);
    uint columns[3] = uint[](before.x, pixel.x, after.x);
    uint rows[3] = uint[](before.y * frame.size.x, index - pixel.x, after.y * frame.size.x);
    float across[3] = float[](pixel.x > 0u ? 0.25 : 0.0, 0.5, pixel.x < last.x ? 0.25 : 0.0);
    float down[3] = float[](pixel.y > 0u ? 0.25 : 0.0, 0.5, pixel.y < last.y ? 0.25 : 0.0);

    Sums diffuse = no_taps(), specular = diffuse;
    add_tap(diffuse, light.diffuse, centre.diffuse_luminance, light.diffuse_deviation, 0.25);
    add_tap(specular, light.specular, centre.specular_luminance, light.specular_deviation, 0.25);
    UNROLLED_FOR (int y = 0; y < 3; y++)
        UNROLLED_FOR (int x = 0; x < 3; x++)
            if (x != 1 || y != 1)
                add_neighbour(diffuse, specular, centre, frame.screen.filter_a, rows[y] + columns[x],
                    make_way(centre, vec2(x - 1, y - 1)), across[x] * down[y], x != 1 && y != 1 ? fall * fall : fall);
    vec2 frames = unpack_moments(load_moments(index)).frames;
    if (frames.x < new_frames && diffuse.weight < few_alike)
        add_farther_taps(diffuse, specular, centre, pixel, index);
    float diffuse_scale = 1.0 / diffuse.weight, specular_scale = 1.0 / specular.weight;
    FilteredLight level = FilteredLight(diffuse.light * diffuse_scale,
        filtered_deviation(diffuse, diffuse_scale, light.diffuse_deviation), specular.light * specular_scale,
        filtered_deviation(specular, specular_scale, light.specular_deviation));
    vec2 shown = vec2(shown_share(frames.x), shown_share(frames.y));
    vec2 kept = vec2(kept_share(frames.x), kept_share(frames.y));
    store_filter_b(index, pack_filtered(mix_light(light, level, shown)));
    store_filtered(index, pack_filtered(mix_light(light, level, kept)));
}

VKPT_RUN_OVER_PIXELS(filter_pixel)
