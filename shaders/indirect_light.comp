#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Light that reaches the primary surface over pt_bounces further surfaces, added to what direct_light stored. With an MIS
// sampler also what its rays find of the emitters that direct_light sampled; then it runs without bounces, too.
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
    uint vertex; // of `surface`: 0 is the primary one
    vec3 throughput;
    vec3 radiance;
    float ray_length; // of the last segment
};

float limit_radiance(vec3 radiance)
{
    float limit = frame.cvars.pt_max_radiance, brightest = max(radiance.r, max(radiance.g, radiance.b));
    return limit > 0.0 && brightest > limit ? limit / brightest : 1.0;
}

// Radiance of what a ray from the path's surface met, as far as light sampling there leaves it over.
vec3 count_emission(BouncePath path, BsdfSample bsdf, HitSurface hit, Random pixel_random)
{
    bool is_sky = (hit.flags & MATERIAL_SKY) != 0u;
    if (hit.emitter == EMITTER_DIM)
        return vec3(0.0);
    if (hit.emitter < 0) {
        // Not in the lists, so that only a bounce finds it.
        if (path.vertex >= uint(frame.cvars.pt_bounces))
            return vec3(0.0);
        return is_sky ? sky_radiance(bsdf.direction) : hit.emission;
    }
    if (!light_sampler_mis || hit.front == 0.0)
        return vec3(0.0);
    float weight = weigh_met_emitter(path.surface, path.cluster, light_random(pixel_random, path.vertex),
        uint(hit.emitter), hit.surface.position, bsdf.pdf);
    // Not the picture's colour there: both ways to find the light must see the same.
    Emitter e = load_emitter(open_light_list(light_tables(), path.cluster), uint(hit.emitter));
    return weight * (e.type == EMITTER_SKY ? sky_radiance(bsdf.direction) : emitted_radiance(e, path.surface.position));
}

// Traces a BSDF sample and moves the path to what it finds. False: the path has ended.
bool bounce_path(inout BouncePath path, BsdfSample bsdf, Random pixel_random)
{
    Ray ray = Ray(leave_surface(path.surface.position, path.surface.geometric_normal), bsdf.direction, 0.0, ray_far);
    RawHit raw = trace_nearest(ray, mask_bounce);
    if (raw.triangle == TRACE_MISS)
        return false; // outside of a closed map; a view without a world has no sky that lights
    path.ray_length = raw.t;
    HitSurface hit = fetch_surface(raw, ray, raw.t * bounce_cone_spread, PICTURE_TEXEL);
    path.radiance += path.throughput * count_emission(path, bsdf, hit, pixel_random);
    if ((hit.flags & MATERIAL_SKY) != 0u || path.vertex >= uint(frame.cvars.pt_bounces))
        return false;
    path.surface = hit.surface;
    path.cluster = hit.cluster;
    path.vertex += 1u;
    ReflectedLight direct = sample_direct_light(
        path.surface, path.cluster, light_random(pixel_random, path.vertex), path.vertex < bsdf_ray_count());
    path.radiance += path.throughput * (direct.diffuse * path.surface.albedo + direct.specular);
    return true;
}

void light_pixel(uvec2 pixel, uint index)
{
    PrimarySurface primary = load_primary_surface(index);
    if (primary.depth < 0.0)
        return;
    Random pixel_random = random_of_pixel(pixel, index);
    BouncePath path = BouncePath(primary.surface, primary.cluster, 0u, vec3(1.0), vec3(0.0), -1.0);
    BsdfValue first = BsdfValue(0.0, vec3(0.0));
    float reflected_distance = -1.0;
    [[dont_unroll]] for (uint bounce = 0u; bounce < bsdf_ray_count(); bounce++) {
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
        bool goes_on = bounce_path(path, bsdf, pixel_random);
        if (bounce == 0u && bsdf.lobe == BSDF_LOBE_SPECULAR)
            reflected_distance = path.ray_length;
        if (!goes_on)
            break;
    }
    store_traced_rays(index, load_ray_count(index));
    store_reflected_distance(index, reflected_distance);
    path.radiance *= limit_radiance(path.radiance);
    store_diffuse_light(index, load_diffuse_light(index) + first.diffuse * path.radiance);
    store_specular_light(index, load_specular_light(index) + first.specular * path.radiance);
}

VKPT_RUN_OVER_PIXELS(light_pixel)
