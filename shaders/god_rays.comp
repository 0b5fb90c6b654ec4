#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Sunlight that fog scatters towards the eye: a few steps along the camera's ray, each with a shadow ray to the sun.
// One pixel of 2 x 2; accumulate.comp spreads it over the others.
#include "lib/frame.glsl"
#include "lib/fog.glsl"
#include "lib/pixel_random.glsl"
#include "lib/reprojection.glsl"
#include "lib/scattered_light.glsl"
#include "lib/surfaces.glsl"

const uint mask_sunlight = MASK_OPAQUE | MASK_ALPHA_TEST | MASK_OWN_BODY | MASK_SKY;
const uint march_steps = 8u;
const uint march_stream = 0x676f64u; // apart from the numbers of the pixel's other passes

// Henyey and Greenstein's phase function (1941), per steradian. `cosine`: between the ways of the light before and
// behind.
float henyey_greenstein(float cosine)
{
    const float g = 0.75;
    float base = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (4.0 * bsdf_pi * base * sqrt(base));
}

bool sees_sun(vec3 point)
{
    RawHit hit = trace_nearest(Ray(point, frame.scene.to_sun, 0.0, ray_far), mask_sunlight);
    if (hit.triangle == TRACE_MISS)
        return false;
    uint material = fetch_Triangle(frame.scene.triangles, hit.triangle).material;
    return (fetch_Material(frame.scene.materials, material).flags & MATERIAL_SKY) != 0u;
}

// How far the air reaches along the camera's ray. What is seen in a mirror, through water or on a screen does not lie
// on it: there the first surface ends it.
float length_in_air(Ray ray, vec4 seen)
{
    const uint mask_camera = MASK_OPAQUE | MASK_TRANSLUCENT | MASK_ALPHA_TEST | MASK_SKY;
    const float most_apart = 0.02; // of the distance: the rays pass the pixel at other places
    if (frame.scene.eye_medium != MEDIUM_NONE)
        return 0.0;
    bool is_surface = seen.w >= 0.0;
    vec3 straight = is_surface ? ray.origin + ray.direction * seen.w : ray.direction;
    if (seen.w != DEPTH_UNLIT && distance(straight, seen.xyz) <= most_apart * (is_surface ? seen.w : 1.0))
        return is_surface ? seen.w : ray_far;
    return trace_nearest(ray, mask_camera).t;
}

void march_pixel(uvec2 half_pixel, uint half_index)
{
    uvec2 pixel = min(half_pixel * 2u, frame.size - 1u);
    Random random = random_stream(make_pixel_random(pixel), march_stream);
    Ray ray = Ray(frame.camera.eye, normalize(camera_direction(pixel, vec2(0.5))), 0.0, ray_far);
    float length = min(length_in_air(ray, load_position(pixel_index(pixel))), scattering_far);
    float step = length / float(march_steps), place = next_float(random), sum = 0.0;
    ROLLED_FOR (uint i = 0u; i < march_steps; i++) {
        float t = (float(i) + place) * step;
        vec3 point = ray.origin + ray.direction * t;
        float density = fog_density(point);
        if (density > 0.0 && sees_sun(point))
            sum += density * look_through_fog(ray, t).transmittance;
    }
    float phase = henyey_greenstein(dot(ray.direction, frame.scene.to_sun));
    vec3 light = frame.scene.sun_irradiance * (sum * step * phase * frame.cvars.pt_god_rays);
    store_scattered(half_index, vec4(light, length));
    add_traced_rays(pixel_index(pixel));
}

VKPT_RUN_OVER_HALF(march_pixel)
