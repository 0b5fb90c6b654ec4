#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// More camera rays through the edges of lamps where the image moves: few frames are averaged there, and one ray would
// show all of the lamp or nothing of it. What the pixel emits becomes the mean over its rays; what it reflects stays.
#include "../lib/frame.glsl"
#include "../lib/camera_rays.glsl"
#include "../lib/exposure.glsl"
#include "../lib/image.glsl"
#include "../lib/reprojection.glsl"

// A lamp: so many times as bright as white, and as the darkest of the pixels around.
const float min_brightness = 2.0, min_contrast = 2.0;
// Rays through such a pixel.
const uint rays = 5u;

// What the image showed last time `way` off the pixel: where that was a lamp, but no ray has met it now, it is one that
// is smaller than a pixel.
float previous_brightness(uvec2 pixel, vec2 way)
{
    vec2 place = ((vec2(pixel) + 0.5) / vec2(frame.size) + way) * vec2(frame.resolved_size);
    return luminance(unpack_light3(load_last_resolved(whole_to_int(floor(place)))));
}

// Whether the pixel or one beside it shows a lamp, or the last image did, and another of them does not.
bool is_edge_of_lamp(uvec2 pixel, float own, float previous)
{
    float least = own, most = quick_max(own, previous);
    uvec2 before = pixel - min(pixel, uvec2(1u)), after = min(pixel + 1u, frame.size - 1u);
    uvec2 neighbours[4]
        = uvec2[](uvec2(before.x, pixel.y), uvec2(after.x, pixel.y), uvec2(pixel.x, before.y), uvec2(pixel.x, after.y));
    UNROLLED_FOR (int tap = 0; tap < 4; tap++) {
        float brightness = brightness_of(load_throughput(pixel_index(neighbours[tap])));
        least = quick_min(least, brightness);
        most = quick_max(most, brightness);
    }
    return most * image_exposure() > min_brightness && most > least * min_contrast;
}

// What one more ray meets, and 1; 0 if that takes more than one ray to tell.
vec4 emission_along(Ray ray)
{
    RawHit raw = trace_nearest(ray, mask_camera);
    if (raw.triangle == TRACE_MISS)
        return vec4(sky_radiance(ray.direction), 1.0);
    HitSurface hit = fetch_surface(raw, ray, raw.t * pixel_spread(), TEXTURE_SMOOTH);
    if ((hit.flags & MATERIAL_SKY) != 0u)
        return vec4(sky_radiance(ray.direction), 1.0);
    const uint more_to_see = MATERIAL_TRANSLUCENT | MATERIAL_FULLBRIGHT | MATERIAL_SCREEN;
    return (hit.flags & more_to_see) != 0u || is_mirror(hit.surface) ? vec4(0.0) : vec4(hit.emission, 1.0);
}

void supersample_pixel(uvec2 pixel, uint index)
{
    if (frame.cvars.pt_debug_view == DEBUG_VIEW_CACHE) // its `emitted` is not what is emitted
        return;
    float previous = 0.0;
    if ((frame.flags & FRAME_HISTORY) != 0u) {
        vec2 way = way_back(pixel, fetch_place(index).xy);
        if (length(way * vec2(frame.size)) < resting_pixels)
            return;
        previous = previous_brightness(pixel, way);
    }
    uvec2 throughput = load_throughput(index);
    if (!is_seen_straight(throughput) || !is_edge_of_lamp(pixel, brightness_of(throughput), previous))
        return;
    vec4 sum = vec4(unpack_floats3(load_emitted(index)), 1.0);
    ROLLED_FOR (uint i = 1u; i < rays; i++) { // the pixel's own ray is the first
        vec3 direction = normalize(perspective_direction(pixel, recurrent_place(frame.pixel_offset, i)));
        sum += emission_along(Ray(frame.camera.eye, direction, 0.0, ray_far));
    }
    add_traced_rays(index);
    store_emitted(index, pack_floats3(sum.rgb / sum.a) | uvec2(0u, is_supersampled));
}

VKPT_RUN_OVER_PIXELS(supersample_pixel)
