// SPDX-License-Identifier: GPL-2.0-or-later
// What pt_debug_view shows instead of the image, as linear colour.
#ifndef VKPT_LIB_DEBUG_VIEWS
#define VKPT_LIB_DEBUG_VIEWS

#include "../denoise/denoise.glsl"
#include "random.glsl"

// A colour that tells neighbouring numbers apart.
vec3 colour_of_number(uint number)
{
    uvec4 h = hash_pcg4(uvec4(number, 1u, 2u, 3u));
    return vec3(h.xyz >> 8u) / 16777216.0;
}

// From 0 to 1: black, blue, magenta, orange, pale yellow. The luminance rises throughout.
vec3 heat_colour(float heat)
{
    const vec3 stops[5] = vec3[5](
        vec3(0.0), vec3(0.03, 0.05, 0.45), vec3(0.50, 0.04, 0.40), vec3(0.95, 0.30, 0.03), vec3(1.0, 0.95, 0.60));
    float place = clamp(heat, 0.0, 1.0) * 4.0;
    uint first = min(uint(place), 3u);
    return mix(stops[first], stops[first + 1u], place - float(first));
}

// Dark stripes: the settings in use do not make this quantity.
vec3 unavailable_colour(uvec2 pixel) { return vec3((pixel.x + pixel.y) / 8u % 2u == 0u ? 0.02 : 0.06); }

// Direction as hue, distance as brightness: 16 pixels a frame are full.
vec3 motion_colour(uvec2 pixel, uint index)
{
    vec2 moved = vec2(pixel) - fetch_place(index).xy;
    if (dot(moved, moved) > 1e8)
        return vec3(0.0); // it was behind the camera
    float turn = atan(moved.y, moved.x) / 6.2831853;
    vec3 hue = clamp(abs(fract(turn + vec3(0.0, 2.0 / 3.0, 1.0 / 3.0)) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
    return hue * min(length(moved) / 16.0, 1.0);
}

// Standard deviation of the filtered light's luminance, relative to it: 1 is hottest. Unknown (too few frames): white.
vec3 variance_colour(uint index)
{
    FilteredLight light = unpack_filtered(load_filtered(index));
    if (!is_known(light.diffuse_deviation) || !is_known(light.specular_deviation))
        return vec3(1.0);
    float mean = luminance(light.diffuse) + luminance(light.specular);
    return heat_colour(length(vec2(light.diffuse_deviation, light.specular_deviation)) / max(mean, 1e-6));
}

// Red for the diffuse lobe, green for the specular one.
vec3 gradient_colour(uvec2 pixel) { return vec3(changed_share(pixel), 0.0); }

// The newest frame's share of the average: red for the diffuse lobe, green for the specular one.
vec3 alpha_colour(uint index) { return vec3(1.0 / max(unpack_moments(load_moments(index)).frames, 1.0), 0.0); }

// Of the average, as it is exposed: brighter than right red, darker blue; a tenth of white is full.
vec3 cache_bias_colour(uint index, float exposure)
{
    float bias = 10.0 * exposure * luminance(load_accumulated(index).rgb);
    return vec3(max(bias, 0.0), 0.0, max(-bias, 0.0));
}

// Quantities of the filters, which are not always on.
vec3 filter_colour(int view, uvec2 pixel, uint index)
{
    bool denoised = (frame.flags & FRAME_DENOISED) != 0u;
    bool replayed = (frame.flags & FRAME_REPLAYED) != 0u && (frame.flags & FRAME_HISTORY) != 0u;
    if (view == DEBUG_VIEW_MOTION && (frame.flags & FRAME_REPROJECTED) != 0u)
        return motion_colour(pixel, index);
    if (view == DEBUG_VIEW_VARIANCE && denoised)
        return variance_colour(index);
    if (view == DEBUG_VIEW_GRADIENT && replayed)
        return gradient_colour(pixel);
    if (view == DEBUG_VIEW_ALPHA && denoised)
        return alpha_colour(index);
    return unavailable_colour(pixel);
}

// `pixel` as rendered.
vec3 debug_colour(int view, uvec2 pixel, uint index, float exposure)
{
    const float max_rays = 16.0, longest_list = 256.0;
    PrimarySurface primary = load_primary_surface(index);
    if (view == DEBUG_VIEW_EMISSION || view == DEBUG_VIEW_CACHE) // see primary_visibility
        return unpack_floats3(load_emitted(index));
    if (view == DEBUG_VIEW_CACHE_BIAS)
        return (frame.flags & FRAME_CACHE_BIAS) != 0u ? cache_bias_colour(index, exposure) : unavailable_colour(pixel);
    if (view == DEBUG_VIEW_RAYS)
        return heat_colour(float(load_ray_count(index)) / max_rays);
    if (primary.depth < 0.0)
        return vec3(0.0);
    Surface s = primary.surface;
    switch (view) {
    case DEBUG_VIEW_ALBEDO:
        return s.albedo;
    case DEBUG_VIEW_NORMAL:
        return s.normal * 0.5 + 0.5;
    case DEBUG_VIEW_DEPTH:
        return vec3(primary.depth / (primary.depth + 512.0));
    case DEBUG_VIEW_CLUSTER:
        return primary.cluster < 0 ? vec3(1.0, 0.0, 1.0) : colour_of_number(uint(primary.cluster));
    case DEBUG_VIEW_LIST_LENGTH:
        return heat_colour(float(light_count(open_light_list(light_tables(), primary.cluster))) / longest_list);
    case DEBUG_VIEW_IRRADIANCE:
        return fetch_reflected_light(index).diffuse;
    case DEBUG_VIEW_ROUGHNESS:
        return vec3(s.roughness, s.metallic, s.coat_loss);
    }
    return filter_colour(view, pixel, index);
}

#endif
