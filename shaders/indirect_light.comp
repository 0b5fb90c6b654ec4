#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Light that reaches the primary surface over pt_bounces further surfaces, added to what direct_light stored.
#include "lib/frame.glsl"
#include "lib/lighting.glsl"
#include "lib/reprojection.glsl"

const uint mask_bounce = MASK_OPAQUE | MASK_ALPHA_TEST | MASK_OWN_BODY | MASK_SKY;
// Bounce rays see pictures through a cone this wide: what is sharp there is noise here.
const float bounce_cone_spread = 0.05;

// Radiance that the next surfaces of a path send back, and how the path goes on.
struct BouncePath {
    Surface surface;
    int cluster;
    vec3 throughput;
    vec3 radiance;
    float ray_length; // of the last segment
};

float limit_radiance(vec3 radiance)
{
    float limit = frame.cvars.pt_max_radiance, brightest = max(radiance.r, max(radiance.g, radiance.b));
    return limit > 0.0 && brightest > limit ? limit / brightest : 1.0;
}

// Samples the BSDF, traces, and moves the path to what it finds. False: the path has ended. `bounce` counts from 0.
bool bounce_path(inout BouncePath path, BsdfSample bsdf, inout Random random)
{
    Ray ray = Ray(leave_surface(path.surface.position, path.surface.geometric_normal), bsdf.direction, 0.0, ray_far);
    RawHit raw = trace_nearest(ray, mask_bounce);
    if (raw.triangle == TRACE_MISS)
        return false; // outside of a closed map; a view without a world has no sky that lights
    path.ray_length = raw.t;
    HitSurface hit = fetch_surface(raw, ray, raw.t * bounce_cone_spread);
    // What the light lists hold has been sampled from the surface before: counting it here would count it twice.
    if (hit.emitter < 0)
        path.radiance += path.throughput
            * ((hit.flags & MATERIAL_SKY) != 0u ? sky_radiance(ray.direction) : hit.emission);
    if ((hit.flags & MATERIAL_SKY) != 0u)
        return false;
    path.surface = hit.surface;
    path.cluster = hit.cluster;
    ReflectedLight direct = sample_direct_light(path.surface, path.cluster, random);
    path.radiance += path.throughput * (direct.diffuse * path.surface.albedo + direct.specular);
    return true;
}

void light_pixel(uvec2 pixel, uint index)
{
    PrimarySurface primary = load_primary_surface(index);
    if (primary.depth < 0.0)
        return;
    Random pixel_random = random_of_pixel(pixel, index);
    BouncePath path = BouncePath(primary.surface, primary.cluster, vec3(1.0), vec3(0.0), -1.0);
    BsdfValue first = BsdfValue(0.0, vec3(0.0));
    float reflected_distance = -1.0;
    [[dont_unroll]] for (uint bounce = 0u; bounce < uint(frame.cvars.pt_bounces); bounce++) {
        Random random = random_for_bounce(pixel_random, bounce + 2u);
        vec2 xi = next_vec2(random);
        BsdfSample bsdf = sample_bsdf(path.surface, xi, next_float(random));
        if (bsdf.pdf <= 0.0)
            break;
        if (bounce == 0u) {
            first.diffuse = bsdf.value.diffuse / bsdf.pdf;
            first.specular = bsdf.value.specular / bsdf.pdf;
        } else {
            path.throughput *= reflected_radiance(path.surface, bsdf.value, vec3(1.0)) / bsdf.pdf;
        }
        bool goes_on = bounce_path(path, bsdf, random);
        if (bounce == 0u && bsdf.lobe == BSDF_LOBE_SPECULAR)
            reflected_distance = path.ray_length;
        if (!goes_on)
            break;
    }
    store_reflected_distance(index, reflected_distance);
    path.radiance *= limit_radiance(path.radiance);
    store_diffuse_light(index, load_diffuse_light(index) + first.diffuse * path.radiance);
    store_specular_light(index, load_specular_light(index) + first.specular * path.radiance);
}

VKPT_RUN_OVER_PIXELS(light_pixel)
