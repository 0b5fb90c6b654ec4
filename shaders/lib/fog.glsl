// SPDX-License-Identifier: GPL-2.0-or-later
// Fog: boxes that maps have, whose density changes evenly along a direction, and pt_fog everywhere, which thins out
// upwards. T = exp(-integral of the density) of light is left.
#ifndef VKPT_LIB_FOG
#define VKPT_LIB_FOG

#include "frame.glsl"
#include "device/quick_floats.glsl"
#include "ray.glsl"

const float fog_far = 16384.0; // farther than any map reaches

// (1 - exp(-x)) / x, for any sign.
float mean_of_fall(float x) { return abs(x) < 1e-3 ? 1.0 - 0.5 * x : (1.0 - exp(-x)) / x; }

// Of pt_fog at a height, per unit.
float height_fog_density(float z)
{
    float height = frame.cvars.pt_fog_height;
    return frame.cvars.pt_fog * (height > 0.0 ? exp(min((frame.cvars.pt_fog_level - z) / height, 20.0)) : 1.0);
}

// Integral of pt_fog's density from the ray's origin to `length`.
float height_fog_depth(Ray ray, float length)
{
    float height = frame.cvars.pt_fog_height, start = height_fog_density(ray.origin.z);
    return start * length * (height > 0.0 ? mean_of_fall(clamp(ray.direction.z * length / height, -20.0, 20.0)) : 1.0);
}

// What the ray has of a box: from and to; nothing where the second is not greater.
vec2 clip_to_box(Ray ray, float length, vec3 mins, vec3 maxs)
{
    vec3 slope = mix(ray.direction, vec3(1e-18), lessThan(abs(ray.direction), vec3(1e-18)));
    vec3 a = (mins - ray.origin) / slope, b = (maxs - ray.origin) / slope;
    vec3 low = min(a, b), high = max(a, b);
    return vec2(max(max(low.x, low.y), max(low.z, 0.0)), min(min(high.x, high.y), min(high.z, length)));
}

// Integral of max(0, b + a t) from t0 to t1.
float integrate_density(float b, float a, float t0, float t1)
{
    if (b + a * t0 < 0.0)
        t0 = a > 0.0 ? -b / a : t1;
    if (b + a * t1 < 0.0)
        t1 = a < 0.0 ? -b / a : t0;
    return quick_max(b * (t1 - t0) + 0.5 * a * (t1 * t1 - t0 * t0), 0.0);
}

float fog_box_depth(FogBox box, Ray ray, float length)
{
    vec2 part = clip_to_box(ray, length, box.mins, box.maxs);
    if (part.y <= part.x)
        return 0.0;
    return integrate_density(
        box.density + dot(box.gradient, ray.origin), dot(box.gradient, ray.direction), part.x, part.y);
}

struct FogOnRay {
    float transmittance;
    vec3 radiance; // that the fog itself adds
};

// Where several fogs lie on each other, each adds its share of what they take together.
FogOnRay look_through_fog(Ray ray, float length)
{
    length = min(length, fog_far);
    float depth = height_fog_depth(ray, length);
    vec3 radiance = depth * frame.scene.fog_radiance;
    ROLLED_FOR (uint i = 0u; i < frame.scene.fog_box_count; i++) {
        float of_box = fog_box_depth(frame.scene.fog_boxes[i], ray, length);
        depth += of_box;
        radiance += of_box * frame.scene.fog_boxes[i].radiance;
    }
    float transmittance = exp(-depth);
    return FogOnRay(transmittance, depth > 0.0 ? radiance * ((1.0 - transmittance) / depth) : vec3(0.0));
}

// Of all fogs at a point, per unit.
float fog_density(vec3 point)
{
    float density = height_fog_density(point.z);
    ROLLED_FOR (uint i = 0u; i < frame.scene.fog_box_count; i++) {
        FogBox box = frame.scene.fog_boxes[i];
        bool inside = all(greaterThanEqual(point, box.mins)) && all(lessThanEqual(point, box.maxs));
        density += inside ? quick_max(box.density + dot(box.gradient, point), 0.0) : 0.0;
    }
    return density;
}

#endif
