#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Light that reaches the primary surface over pt_bounces further surfaces, added to what direct_light stored. With an MIS
// sampler also what its rays find of the emitters that direct_light sampled; then it runs without bounces, too.
#include "lib/frame.glsl"
#include "lib/bounce_blocks.glsl"
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
#ifdef VKPT_SAMPLER_MIS
    if (hit.front == 0.0)
        return vec3(0.0);
    float weight = weigh_met_emitter(path.surface, path.cluster, light_random(pixel_random, path.vertex),
        uint(hit.emitter), hit.surface.position, bsdf.pdf);
    // Not the picture's colour there: both ways to find the light must see the same.
    Emitter e = load_emitter(open_light_list(light_tables(), path.cluster), uint(hit.emitter));
    return weight * (e.type == EMITTER_SKY ? sky_radiance(bsdf.direction) : emitted_radiance(e, path.surface.position));
#else
    return vec3(0.0);
#endif
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

// What the path of a pixel has found.
struct FoundLight {
    vec3 radiance;
    vec3 direction; // where the first BSDF sample went
    float pdf;      // its density; 0: nothing was found
    float reflected_distance;
};

// `reflected`: what the pixel's surface reflects of the radiance, by the density it was found with.
FoundLight follow_path(uvec2 pixel, uint index, PrimarySurface primary, out BsdfValue reflected)
{
    Random pixel_random = random_of_pixel(pixel, index);
    BouncePath path = BouncePath(primary.surface, primary.cluster, 0u, vec3(1.0), vec3(0.0), -1.0);
    FoundLight found = FoundLight(vec3(0.0), vec3(0.0), 0.0, -1.0);
    reflected = BsdfValue(0.0, vec3(0.0));
    [[dont_unroll]] for (uint bounce = 0u; bounce < bsdf_ray_count(); bounce++) {
        Random random = random_for_bounce(pixel_random, bounce + 2u);
        vec2 xi = next_vec2(random);
        BsdfSample bsdf = sample_bsdf(path.surface, xi, next_float(random));
        if (bsdf.pdf <= 0.0)
            break;
        if (bounce == 0u) {
            found.direction = bsdf.direction;
            found.pdf = bsdf.pdf;
            reflected = BsdfValue(bsdf.value.diffuse / bsdf.pdf, bsdf.value.specular / bsdf.pdf);
        } else {
            path.throughput *= reflected_radiance(path.surface, bsdf.value, vec3(1.0)) / bsdf.pdf;
        }
        bool goes_on = bounce_path(path, bsdf, pixel_random);
        if (bounce == 0u && bsdf.lobe == BSDF_LOBE_SPECULAR)
            found.reflected_distance = path.ray_length;
        if (!goes_on)
            break;
    }
    store_traced_rays(index, load_ray_count(index));
    found.radiance = path.radiance * limit_radiance(path.radiance);
    return found;
}

void add_light(uint index, BsdfValue reflected, vec3 radiance, float reflected_distance)
{
    store_reflected_distance(index, reflected_distance);
    ReflectedLight light = load_reflected_light(index);
    store_reflected_light(
        index, ReflectedLight(light.diffuse + reflected.diffuse * radiance, light.specular + reflected.specular * radiance));
}

// Narrower lobes reflect something else one pixel on: such surfaces send rays of their own.
const float least_shared_roughness = 0.2;
bool sends_own_rays(PrimarySurface p) { return p.surface.roughness < least_shared_roughness; }

// Of a block's pixel; without depth where it lies outside the screen.
PrimarySurface load_block_surface(uvec2 pixel)
{
    PrimarySurface primary = load_primary_surface(is_on_screen(pixel) ? pixel_index(pixel) : 0u);
    primary.depth = is_on_screen(pixel) ? primary.depth : DEPTH_NOTHING;
    return primary;
}

// Whether the last view showed what the pixel shows, so that the filters have older light to add to.
bool was_seen(uvec2 pixel)
{
    if (!is_on_screen(pixel))
        return false;
    uint index = pixel_index(pixel), there;
    Search search = make_search(load_guide(index), unpack_upper_halves(load_slope(index)), load_motion(index));
    return shows_surface(search, nearest_in_last_view(search.shown.xy), there);
}

// Whether the block has no history: what its pixels share would stand out as specks then. Beside an edge, or of a thin thing, one of two
// opposite pixels may have one.
bool is_new(BounceBlock block)
{
    if ((frame.flags & FRAME_HISTORY) == 0u)
        return true;
    bool seen = was_seen(pixel_of_block(block, 0u));
    if (!seen)
        seen = was_seen(pixel_of_block(block, bounce_block_pixels() - 1u));
    return !seen;
}

// Whether the same light falls on two neighbouring pixels, and their lobes are alike.
bool are_alike(PrimarySurface a, PrimarySurface b)
{
    const float least_cosine = 0.97, most_roughness_difference = 0.1, most_off_plane = 0.008; // of the depth
    vec3 way = b.surface.position - a.surface.position;
    float off = max(abs(dot(way, a.surface.geometric_normal)), abs(dot(way, b.surface.geometric_normal)));
    return a.depth >= 0.0 && b.depth >= 0.0 && !sends_own_rays(a) && !sends_own_rays(b)
        && off <= most_off_plane * min(a.depth, b.depth) && dot(a.surface.normal, b.surface.normal) >= least_cosine
        && abs(a.surface.roughness - b.surface.roughness) <= most_roughness_difference
        && abs(a.surface.metallic - b.surface.metallic) < 0.5;
}

// A bit for each pixel of the block that takes over what its leader finds, the leader included; 0: nobody does.
uint find_alike(BounceBlock block)
{
    PrimarySurface leader = load_block_surface(pixel_of_block(block, 0u));
    uint alike = are_alike(leader, leader) ? 1u : 0u;
    [[dont_unroll]] for (uint i = 1u; i < bounce_block_pixels(); i++)
        alike |= are_alike(leader, load_block_surface(pixel_of_block(block, i))) ? 1u << i : 0u;
    return alike;
}

// The leader's path, and those of pixels that do not share. What the leader found goes to the pixels that are like it, as if each
// had sent the ray. Who has fewer of its kind in the block is lit more seldom, as those have fewer turns to lead, and the
// more when it is: the mean stays. Where the last view did not show what the block does, all go their own way.
void light_block(uvec2 number, uint)
{
    BounceBlock block = open_bounce_block(number);
    uint pixels = bounce_block_pixels();
    bool shares = pixels > 1u && !is_new(block);
    uint alike = shares ? find_alike(block) : 0u;
    float scale = alike != 0u ? float(pixels) / float(bitCount(alike)) : 1.0;
    FoundLight found = FoundLight(vec3(0.0), vec3(0.0), 0.0, -1.0);
    [[dont_unroll]] for (uint i = 0u; i < pixels; i++) {
        uvec2 pixel = pixel_of_block(block, i);
        uint index = pixel_index(pixel);
        PrimarySurface primary = load_block_surface(pixel);
        bool leads = i == 0u, alone = !shares || sends_own_rays(primary);
        if (primary.depth >= 0.0) {
            if (leads || alone) {
                BsdfValue reflected;
                FoundLight own = follow_path(pixel, index, primary, reflected);
                add_light(index, reflected, own.radiance * (leads ? scale : 1.0), own.reflected_distance);
                if (leads)
                    found = own;
            } else if ((alike >> i & 1u) != 0u && found.pdf > 0.0) {
                add_light(index, evaluate_bsdf(primary.surface, found.direction), found.radiance * (scale / found.pdf),
                    found.reflected_distance);
            } else {
                store_reflected_distance(index, -1.0);
            }
            // Others' light, and more than its own, is no sample of the pixel that could be repeated.
            bool own_sample = alone || (leads && scale == 1.0);
            if (!own_sample && (frame.flags & FRAME_REPLAYED) != 0u)
                store_random_seed(index, no_random_seed);
        }
    }
}

VKPT_RUN_OVER_BLOCKS(light_block)
