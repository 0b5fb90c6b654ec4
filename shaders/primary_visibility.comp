#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Camera rays through mirrors, glass and water to the first surface that is shaded, written to the G-buffer.
#include "lib/frame.glsl"
#include "lib/pixel_random.glsl"
#include "lib/surfaces.glsl"

const uint max_specular_segments = 8u;
const uint mask_camera = MASK_OPAQUE | MASK_TRANSLUCENT | MASK_ALPHA_TEST | MASK_VIEW_WEAPON | MASK_SKY;
const uint mask_reflected = MASK_OPAQUE | MASK_TRANSLUCENT | MASK_ALPHA_TEST | MASK_OWN_BODY | MASK_SKY;
// Metals smoother than this are mirrors.
const float mirror_roughness = 0.06;
const float water_index = 1.33;
// Absorption of water per unit of length (a unit is about an inch); red goes first.
const vec3 water_absorption = vec3(0.0045, 0.0016, 0.0010);

Ray camera_ray(uvec2 pixel, vec2 offset)
{
    vec2 screen = (vec2(pixel) + offset) / vec2(frame.size) * 2.0 - 1.0;
    vec3 direction = frame.camera.forward + frame.camera.right * screen.x - frame.camera.up * screen.y;
    return Ray(frame.camera.eye, normalize(direction), 0.0, ray_far);
}

// Unpolarised Fresnel reflectance of a smooth dielectric; `ratio` = index behind / index before. 1: total reflection.
float fresnel_dielectric(float cosine, float ratio)
{
    float g2 = ratio * ratio - 1.0 + cosine * cosine;
    if (g2 <= 0.0)
        return 1.0;
    float g = sqrt(g2), a = (g - cosine) / (g + cosine), b = (cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}

// A few crossing waves; the gradient of their height turns the surface normal.
vec3 water_normal(vec3 position, vec3 normal)
{
    if (abs(normal.z) < 0.7)
        return normal;
    vec2 p = position.xy;
    float t = frame.time;
    vec2 slope = 0.020 * cos(dot(p, vec2(0.050, 0.031)) + 1.3 * t) * vec2(0.85, 0.53)
        + 0.016 * cos(dot(p, vec2(-0.043, 0.071)) + 1.7 * t) * vec2(-0.52, 0.85)
        + 0.010 * cos(dot(p, vec2(0.131, -0.083)) + 2.6 * t) * vec2(0.84, -0.54);
    return normalize(normal - vec3(slope, 0.0) * sign(normal.z));
}

struct Path {
    Ray ray;
    vec3 throughput;
    vec3 emitted;
    float path_length;
    uint mask;
    bool in_water;
    float unlit_depth; // DEPTH_*: what the path ended on without a surface
    bool reached_surface;
    HitSurface hit;
};

void reflect_path(inout Path path, Surface s, vec3 normal)
{
    path.ray.direction = reflect(path.ray.direction, normal);
    if (dot(path.ray.direction, s.geometric_normal) < 1e-3)
        path.ray.direction = normalize(path.ray.direction + s.geometric_normal * 0.02);
    path.ray.origin = leave_surface(s.position, s.geometric_normal);
    path.mask = mask_reflected;
}

void pass_through(inout Path path, Surface s, vec3 direction)
{
    path.ray.direction = direction;
    path.ray.origin = leave_surface(s.position, -s.geometric_normal);
}

void meet_water(inout Path path, Surface s, inout Random random)
{
    vec3 normal = water_normal(s.position, s.normal);
    float ratio = path.in_water ? 1.0 / water_index : water_index;
    float reflectance = fresnel_dielectric(clamp(dot(normal, s.view), 0.0, 1.0), ratio);
    if (next_float(random) < reflectance) {
        reflect_path(path, s, normal);
        return;
    }
    vec3 refracted = refract(path.ray.direction, normal, 1.0 / ratio);
    if (refracted == vec3(0.0)) {
        reflect_path(path, s, normal);
        return;
    }
    path.in_water = !path.in_water;
    pass_through(path, s, refracted);
}

// Follows the path over one segment. False: it has ended.
bool follow_path(inout Path path, float cone_spread, inout Random random)
{
    RawHit raw = trace_nearest(path.ray, path.mask);
    if (path.in_water)
        path.throughput *= exp(-water_absorption * min(raw.t, 8192.0));
    if (raw.triangle == TRACE_MISS) {
        path.emitted += path.throughput * sky_radiance(path.ray.direction);
        return false;
    }
    path.path_length += raw.t;
    HitSurface hit = fetch_surface(raw, path.ray, path.path_length * cone_spread);
    Surface s = hit.surface;
    if ((hit.flags & MATERIAL_SKY) != 0u) {
        path.emitted += path.throughput * sky_radiance(path.ray.direction);
        return false;
    }
    if ((hit.flags & MATERIAL_TRANSLUCENT) != 0u) {
        if ((hit.flags & MATERIAL_WARP) != 0u) {
            meet_water(path, s, random);
            return true;
        }
        if (next_float(random) >= hit.opacity) {
            pass_through(path, s, path.ray.direction);
            return true;
        }
    }
    if ((hit.flags & MATERIAL_FULLBRIGHT) != 0u) {
        path.emitted += path.throughput * s.albedo;
        path.unlit_depth = DEPTH_UNLIT;
        return false;
    }
    path.emitted += path.throughput * hit.emission;
    if (s.metallic > 0.5 && s.roughness < mirror_roughness) {
        path.throughput *= s.albedo + (1.0 - s.albedo) * schlick_power(dot(s.normal, s.view));
        reflect_path(path, s, s.normal);
        return true;
    }
    path.hit = hit;
    path.reached_surface = true;
    return false;
}

void see_pixel(uvec2 pixel, uint index)
{
    Random random = make_pixel_random(pixel);
    vec2 offset = (frame.flags & FRAME_JITTER) != 0u ? next_vec2(random) : vec2(0.5);
    Path path;
    path.ray = camera_ray(pixel, offset);
    path.throughput = vec3(1.0);
    path.emitted = vec3(0.0);
    path.path_length = 0.0;
    path.mask = mask_camera;
    path.in_water = (frame.flags & FRAME_UNDERWATER) != 0u;
    path.reached_surface = false;
    path.unlit_depth = DEPTH_NOTHING;
    float cone_spread = 2.0 * length(frame.camera.right) / float(frame.size.x);

    [[dont_unroll]] for (uint segment = 0u; segment < max_specular_segments; segment++)
        if (!follow_path(path, cone_spread, random))
            break;

    store_emitted(index, path.emitted);
    store_throughput(index, pack_half3(path.throughput));
    if (!path.reached_surface) {
        store_position(index, vec4(path.ray.direction, path.unlit_depth));
        return;
    }
    store_position(index, vec4(path.hit.surface.position, path.path_length));
    store_surface(index, path.hit);
}

VKPT_RUN_OVER_PIXELS(see_pixel)
