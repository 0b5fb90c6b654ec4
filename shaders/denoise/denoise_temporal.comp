#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// This frame's light, averaged with what the last view knew of the same surface; and how much it varies.
#include "../lib/frame.glsl"
#include "../lib/exposure.glsl"
#include "denoise.glsl"
#include "../lib/interleaved_layers.glsl"

// Frames that the averages are worth at most; specular light's where the image moves, for what a surface reflects
// moves otherwise.
const float max_frames = 32.0, max_moving_frames = 4.0;
const float max_moment_frames = 16.0;
// From so many frames on, their variance is believed.
const float min_frames = 4.0;
// Smoother surfaces show their reflections, which move as things behind them.
const float glossy_roughness = 0.3;

struct History {
    FilteredLight light; // its deviations 0 where they are unknown
    Moments moments; // frames 0: nothing is known
};

// What is averaged over the taps: by how much the taps differ is how the image varies from place to place, not the
// light from frame to frame.
float variance_of(vec2 mean_and_root)
{
    return quick_max(mean_and_root.y * mean_and_root.y - mean_and_root.x * mean_and_root.x, 0.0);
}

// In `sum`, moments are mean and variance.
void add_history(inout History sum, inout float total, ReprojectionQuery query, ivec2 place, float share)
{
    uint there;
    if (!shows_surface(query, place, there) || share < 1e-3)
        return;
    FilteredLight light = unpack_filtered(load_previous_filtered(there));
    Moments moments = unpack_moments(load_previous_moments(there));
    sum.light.diffuse += light.diffuse * share;
    sum.light.specular += light.specular * share;
    sum.light.diffuse_deviation += quick_max(light.diffuse_deviation, 0.0) * share;
    sum.light.specular_deviation += quick_max(light.specular_deviation, 0.0) * share;
    sum.moments.diffuse += vec2(moments.diffuse.x, variance_of(moments.diffuse)) * share;
    sum.moments.specular += vec2(moments.specular.x, variance_of(moments.specular)) * share;
    sum.moments.frames += moments.frames * share;
    sum.moments.specular_hit_distance += moments.specular_hit_distance * share;
    total += share;
}

// Pixels that share out layers show another one in each view; neighbours on all sides have shown this one.
void add_layer_history(inout History sum, inout float total, ReprojectionQuery query, ivec2 place)
{
    ROLLED_FOR (int tap = 0; tap < 9; tap++)
        add_history(sum, total, query, place + ivec2(tap % 3, tap / 3) - 1, 1.0 / 9.0);
}

// The four pixels of the last view around where the surface was then, as far as they show the same surface. `at`: where
// to look for what the surface showed. Its moments are mean and mean square.
History find_history(uint index, ReprojectionQuery query, vec2 at)
{
    History none = History(
        FilteredLight(vec3(0.0), 0.0, vec3(0.0), 0.0), Moments(vec2(0.0), vec2(0.0), vec2(0.0), 0.0, vec2(0.0)));
    if ((frame.flags & FRAME_HISTORY) == 0u)
        return none;
    at = clamp(at, vec2(-2.0), vec2(frame.previous_size) + 2.0);
    vec2 corner = floor(at), part = at - corner;
    ivec2 first = whole_to_int(corner);
    History sum = none;
    float total = 0.0;
    UNROLLED_FOR (int y = 0; y < 2; y++)
        UNROLLED_FOR (int x = 0; x < 2; x++)
            add_history(sum, total, query, first + ivec2(x, y),
                (x == 0 ? 1.0 - part.x : part.x) * (y == 0 ? 1.0 - part.y : part.y));
    if (total < 0.01 && (frame.flags & FRAME_LAYERED) != 0u && differing_layers(index) != 0u)
        add_layer_history(sum, total, query, nearest_in_last_view(at));
    if (total < 0.01)
        return none;
    float scale = 1.0 / total;
    sum.light.diffuse *= scale;
    sum.light.specular *= scale;
    sum.light.diffuse_deviation *= scale;
    sum.light.specular_deviation *= scale;
    sum.moments.diffuse *= scale;
    sum.moments.specular *= scale;
    sum.moments.diffuse.y += sum.moments.diffuse.x * sum.moments.diffuse.x;
    sum.moments.specular.y += sum.moments.specular.x * sum.moments.specular.x;
    sum.moments.frames *= scale;
    sum.moments.specular_hit_distance *= scale;
    return sum;
}

// What is known of specular light is known from elsewhere. The distance to what is reflected stays the surface's.
void take_specular(inout History history, History other)
{
    history.light.specular = other.light.specular;
    history.light.specular_deviation = other.light.specular_deviation;
    history.moments.specular = other.moments.specular;
    history.moments.frames.y = other.moments.frames.y;
}

// A deviation of few samples is uncertain, and mostly too low where few of them meet a light: it counts for so many
// times as much at first, and for once from 12 frames on.
const float few_frames_slack = 2.5, enough_frames = 12.0;
float slack_of(float frames)
{
    float share = (frames - min_frames) / (enough_frames - min_frames);
    return mix(few_frames_slack, 1.0, clamp(share, 0.0, 1.0));
}

// Deviation of the average: that of one frame, over the root of the frames that the average is worth. As FilteredLight
// has it. `filtered`: of what the last view's filter left, and the average still holds most of. A pixel's own frames do
// not tell how uncertain the light is that the filter brought in from a neighbour: counted as certain, a rare bright
// sample stayed as a ring of the eight pixels around it.
float average_deviation(vec2 mean_and_square, float frames, float filtered)
{
    if (frames < min_frames)
        return -sqrt(mean_and_square.y);
    float variance = quick_max(mean_and_square.y - mean_and_square.x * mean_and_square.x, 0.0);
    return quick_max(slack_of(frames) * sqrt(variance / frames), filtered * (1.0 - 1.0 / frames));
}

// A rare path of great radiance must not stay in the history for seconds: new light counts up to so many times of what
// is known of the place (biased; the more frames tell, the less).
const float max_times_brighter = 50.0;
// Added to what is known, as a share of the image's range: in the dark, and more so where little is known yet.
const float min_known = 0.02, min_known_at_first = 0.1;

// `changed`: lambda.
vec3 limit_firefly(vec3 light, vec3 known, float frames, float changed)
{
    if (changed > 0.1)
        return light;
    float dark = (frames < min_frames ? min_known_at_first : min_known) / image_exposure();
    float limit = max_times_brighter * (luminance(known) + dark), l = luminance(light);
    return l > limit ? light * (limit / l) : light;
}

// Of either lobe. By what share the pixel's light is less.
float limit_fireflies(inout vec3 diffuse, inout vec3 specular, ReflectedLight known, vec2 frames, vec2 changed)
{
    float before = luminance(diffuse) + luminance(specular);
    diffuse = limit_firefly(diffuse, known.diffuse, frames.x, changed.x);
    specular = limit_firefly(specular, known.specular, frames.y, changed.y);
    float after = luminance(diffuse) + luminance(specular);
    return after < before ? 1.0 - after / before : 0.0;
}

// What is known where the history tells little: this frame's light around the pixel. From two pixels off, as nearer
// ones may share the pixel's own bounce ray (lib/bounce_blocks.glsl). Without it a ledge of one pixel under a lamp
// stayed dark: anti-aliasing's jitter takes its history away in most frames.
ReflectedLight light_around(uvec2 pixel)
{
    ReflectedLight sum = no_reflected_light;
    ROLLED_FOR (int tap = 0; tap < 9; tap++) {
        uvec2 at = uvec2(ivec2(pixel) + (ivec2(tap % 3, tap / 3) - 1) * 2);
        if (tap == 4 || !is_on_screen(at))
            continue;
        ReflectedLight light = fetch_reflected_light(pixel_index(at));
        bool nonfinite = is_nonfinite(light.diffuse) || is_nonfinite(light.specular);
        sum.diffuse += nonfinite ? vec3(0.0) : light.diffuse * 0.125;
        sum.specular += nonfinite ? vec3(0.0) : light.specular * 0.125;
    }
    return sum;
}

// Averaged, for the specular lobe is sampled now and then only.
float update_specular_hit_distance(uint index, float before)
{
    float now = load_specular_hit_distance(index);
    if (now <= 0.0)
        return before;
    now = quick_min(now, 16384.0);
    return before > 0.0 ? mix(before, now, 0.2) : now;
}

// Where the last view showed what the surface reflects: as far along the camera's ray as the light has come.
vec2 place_of_reflection(vec3 direction, float distance)
{
    ScreenPoint before = project(frame.previous_camera, frame.camera.eye + direction * distance, frame.previous_size);
    return place_in_last_view(before, frame.pixel_offset);
}

// Over so many pixels the lobe spreads what it reflects; 1 of what touches it.
float find_lobe_reach(float roughness, float path_length, float distance)
{
    float spread = 2.0 * ggx_alpha(roughness) * distance / (distance + path_length);
    return 1.0 + spread / pixel_spread();
}

// Lambda: the share of the light (diffuse, specular) that has changed since the last view around this pixel.
vec2 find_lambda(uvec2 pixel)
{
    const uint measured = FRAME_REPLAYED | FRAME_HISTORY;
    return (frame.flags & measured) == measured ? changed_share(pixel) : vec2(0.0);
}

// Of specular light, where its history is the surface's: as many as leave what is reflected, sliding so many pixels in
// each, within this share of its lobe.
const float max_lobe_share = 0.12;
float max_specular_frames(float slide, float reach)
{
    return clamp(max_lobe_share * reach / quick_max(slide, 0.01), 1.0, max_frames);
}

// The same where the history is that of what is reflected: less and less up to a quarter of a pixel in a frame.
float max_glossy_frames(uvec2 pixel, vec2 shown)
{
    vec2 moved = abs(shown - ((vec2(pixel) + 0.5) * frame.previous_scale - 0.5));
    return mix(max_frames, max_moving_frames, quick_min(4.0 * quick_max(moved.x, moved.y), 1.0));
}

// Without spatial filter this is already what the next view accumulates on.
void store_light(uint index, uvec4 light)
{
    if (frame.cvars.flt_denoiser == DENOISER_TEMPORAL)
        store_filtered(index, light);
    else
        store_filter_a(index, light);
}

// What fireflies are measured by: the history, where it is long enough, else this frame's neighbours.
ReflectedLight known_light(uvec2 pixel, Surface surface, History history)
{
    ReflectedLight known = ReflectedLight(history.light.diffuse, history.light.specular);
    bvec2 is_new = lessThan(history.moments.frames, vec2(min_frames));
    if (any(is_new)) {
        ReflectedLight around = light_around(pixel);
        known.diffuse = is_new.x ? around.diffuse : known.diffuse;
        known.specular = is_new.y ? around.specular / specular_tint(surface) : known.specular;
    }
    return known;
}

void accumulate_pixel(uvec2 pixel, uint index)
{
    uvec2 features = load_features(index);
    if (feature_depth(features) <= 0.0) {
        store_light(index, uvec4(0u));
        store_moments(index, uvec4(0u));
        return;
    }
    Surface surface; // its material alone
    unpack_material(load_surface(index), surface);
    ReflectedLight reflected = fetch_reflected_light(index);
    vec2 newest = luminances(reflected);
    vec3 diffuse = reflected.diffuse, specular = reflected.specular / specular_tint(surface);
    if (is_nonfinite(diffuse) || is_nonfinite(specular)) {
        count_nonfinite_pixel();
        diffuse = specular = vec3(0.0); // or it would stay in the history
    }
    uint depth_gradient = load_depth_gradient(index);
    ReprojectionQuery query = make_query(features, unpack_upper_halves(depth_gradient), fetch_place(index));
    History history = find_history(index, query, query.shown.xy);
    float specular_hit_distance = update_specular_hit_distance(index, history.moments.specular_hit_distance);
    vec3 direction = perspective_direction(pixel, frame.pixel_offset);
    float direction_length = length(direction), path_length = feature_depth(features) * direction_length;
    float reach = find_lobe_reach(surface.roughness, path_length, specular_hit_distance);
    float max_specular = max_glossy_frames(pixel, query.shown.xy);
    if (specular_hit_distance > 0.0) {
        vec2 image = place_of_reflection(direction, (path_length + specular_hit_distance) / direction_length);
        if (surface.roughness < glossy_roughness) {
            take_specular(history, find_history(index, query, image));
        } else {
            max_specular = max_specular_frames(length(image - query.shown.xy), reach);
        }
    }
    vec2 changed = find_lambda(pixel);
    float cut_share
        = limit_fireflies(diffuse, specular, known_light(pixel, surface, history), history.moments.frames, changed);
    vec2 frames = quick_min(history.moments.frames + 1.0, vec2(max_frames, max_specular));
    frames = 1.0 / mix(1.0 / frames, vec2(1.0), changed);
    vec2 share = 1.0 / frames;
    vec2 moment_share = 1.0 / quick_min(frames, vec2(max_moment_frames));
    vec2 now = vec2(luminance(diffuse), luminance(specular));
    vec2 diffuse_moments = mix(history.moments.diffuse, vec2(now.x, now.x * now.x), moment_share.x);
    vec2 specular_moments = mix(history.moments.specular, vec2(now.y, now.y * now.y), moment_share.y);
    FilteredLight light;
    light.diffuse = mix(history.light.diffuse, diffuse, share.x);
    light.specular = mix(history.light.specular, specular, share.y);
    light.diffuse_deviation = average_deviation(diffuse_moments, frames.x, history.light.diffuse_deviation);
    light.specular_deviation = average_deviation(specular_moments, frames.y, history.light.specular_deviation);
    store_light(index, pack_filtered(light));
    store_moments(index,
        pack_moments(Moments(vec2(diffuse_moments.x, sqrt(diffuse_moments.y)),
            vec2(specular_moments.x, sqrt(specular_moments.y)), frames, specular_hit_distance, newest)));
    // One ray's distance tells little: beside an edge it ends near, and light that mixes with no neighbours is a speck.
    if (frames.y < min_frames && specular_hit_distance > 0.0)
        reach = find_lobe_reach(surface.roughness, path_length, quick_max(specular_hit_distance, path_length));
    // See specular_fall. Filters must not reach farther than the lobe, or reflections blur.
    float fall = specular_hit_distance > 0.0 ? 1.0 / (reach * reach) : 0.0;
    store_filter_reach(index, uvec2(depth_gradient, pack_upper_halves(vec2(fall, cut_share))));
}

VKPT_RUN_OVER_PIXELS(accumulate_pixel)
