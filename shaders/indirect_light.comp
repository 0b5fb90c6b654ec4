#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Light that reaches the primary surface over pt_bounces further surfaces, added to what direct_light stored. With an
// MIS sampler also what its rays find of the emitters that direct_light sampled; then it runs without bounces, too.
#define VKPT_NORMAL_MAPS
#include "lib/frame.glsl"
#include "lib/bounce_blocks.glsl"
#include "lib/guides.glsl"
#include "lib/light_cache.glsl"
#include "lib/lighting.glsl"
#include "lib/reprojection.glsl"

const uint mask_bounce = MASK_OPAQUE | MASK_ALPHA_TEST | MASK_OWN_BODY | MASK_SKY;
// Bounce rays see images through a cone this wide: what is sharp there is noise here.
const float bounce_cone_spread = 0.05;

// Radiance that the next surfaces of a path send back, and how the path goes on.
struct BouncePath {
    Surface surface;
    int cluster;
    uint vertex; // of `surface`: 0 is the primary one
    vec3 throughput;
    vec3 radiance;
    float ray_length; // of the last segment
    vec3 met; // where the last segment ended
    uint guide; // that it ended on, 0: none
    bool lit_by_cache; // the surface: its direct light is complete, whatever MIS makes of it elsewhere
};

// Nearer than this a surface's light varies over what the ray's end stands for: it is sampled.
const float min_cached_distance = 32.0;

float limit_radiance(vec3 radiance)
{
    float limit = frame.cvars.pt_max_radiance, brightest = max(radiance.r, max(radiance.g, radiance.b));
    return limit > 0.0 && brightest > limit ? limit / brightest : 1.0;
}

// Radiance of what a ray from the path's surface met, as far as light sampling there leaves it over.
vec3 count_emission(BouncePath path, BsdfSample bsdf, HitSurface hit, Random pixel_random)
{
    bool is_sky = (hit.flags & MATERIAL_SKY) != 0u;
    if (hit.emitter == EMITTER_SAMPLED_APART)
        return vec3(0.0);
    if (hit.emitter < 0) {
        // Not in the lists, so that only a bounce finds it.
        if (path.vertex >= bounce_count())
            return vec3(0.0);
        return is_sky ? sky_radiance(bsdf.direction) : hit.emission;
    }
#ifdef VKPT_SAMPLER_MIS
    if (hit.front == 0.0 || path.lit_by_cache)
        return vec3(0.0);
    float weight = weigh_met_emitter(path.surface, path.cluster, light_random(pixel_random, path.vertex),
        uint(hit.emitter), hit.surface.position, bsdf.pdf);
    // Not the image's colour there: both ways to find the light must see the same.
    Emitter e = load_emitter(open_light_list(light_tables(), path.cluster), uint(hit.emitter));
    return weight * (e.type == EMITTER_SKY ? sky_radiance(bsdf.direction) : emitted_radiance(e, path.surface.position));
#else
    return vec3(0.0);
#endif
}

// What the light cache knows of the light that the map's own lights send to what the path has just met.
CachedLight find_cached_light(HitSurface hit)
{
    if ((frame.flags & (FRAME_LIGHT_CACHE | FRAME_GUIDES)) == 0u || hit.front == 0.0)
        return nothing_cached;
    return read_light_cache(hit.face, hit.surface.position);
}

layout(constant_id = INDIRECT_CONSTANT) const int fixed_indirect = NOT_FIXED;
bool corrects_cache()
{
    return (fixed_indirect == NOT_FIXED ? frame.cvars.pt_indirect : fixed_indirect) == INDIRECT_BOTH;
}

// pt_indirect both: the share of the places read from the cache that a light is chosen at, too.
float corrected_share() { return corrects_cache() ? frame.cvars.pt_cache_corrected : 0.0; }

const uint correction_dimension = 15u; // in a bounce's block, behind those of guides

bool shows_cache_bias() { return corrects_cache() && (frame.flags & FRAME_CACHE_BIAS) != 0u; }

// Radiance that the path's new surface sends back of the light that arrives there directly. Where it is read from the
// cache, the cache may be a control variate: at a share q of such places a static light is chosen as well, and 1 / q of
// the difference is added. The mean is that of chosen lights, whatever the cache holds.
vec3 reflect_direct_light(inout BouncePath path, CachedLight cached, Random pixel_random)
{
    bool known = (frame.flags & FRAME_LIGHT_CACHE) != 0u && cached.known && path.ray_length >= min_cached_distance
        && reflects_like_cache(path.surface);
    path.lit_by_cache = known;
    float share = known ? corrected_share() : 0.0;
    Random correction = random_for_bounce(pixel_random, path.vertex + 1u);
    correction.dimension += correction_dimension;
    bool corrected = share > 0.0 && next_float(correction) < share;
    LightRandom random = light_random(pixel_random, path.vertex);
    LightListView list = open_light_list_for(random, path.cluster);
    vec3 radiance = vec3(0.0);
    if (known) {
        float rest = (shows_cache_bias() ? 0.0 : 1.0) - (corrected ? 1.0 / share : 0.0);
        radiance = rest * reflect_cached_light(path.surface, cached);
    }
    // Lights that the cache does not know; then those that it does.
    ROLLED_FOR (uint part = shows_cache_bias() ? 1u : 0u; part < (corrected ? 2u : 1u); part++) {
        LightListView lights = list;
        if (part == 1u)
            lights = static_lights(list);
        else if (known)
            lights = dynamic_lights(list);
        ReflectedLight direct = no_reflected_light;
        if (light_count(lights) > 0u)
            direct = sample_lights(lights, path.surface, random, !known && path.vertex < bsdf_ray_count());
        vec3 traced = direct.diffuse * path.surface.albedo + direct.specular;
        radiance += part == 1u ? traced / share : traced;
        if (!corrects_cache()) // compilers that know it drop the loop
            break;
    }
    return known && shows_cache_bias() ? -radiance : radiance;
}

// Traces a ray and moves the path to what it finds, of which `cached` is known. False: the path has ended.
bool bounce_path(inout BouncePath path, BsdfSample bsdf, Random pixel_random, out CachedLight cached)
{
    cached = nothing_cached;
    Ray ray
        = Ray(offset_ray_origin(path.surface.position, path.surface.geometric_normal), bsdf.direction, 0.0, ray_far);
    vec3 transmittance;
    RawHit raw = trace_filtered(ray, mask_bounce, false, false, transmittance);
    path.throughput *= transmittance;
    path.guide = 0u;
    if (raw.triangle == TRACE_MISS)
        return false; // outside of a closed map; a view without a world has no sky that lights
    path.ray_length = raw.t;
    HitSurface hit = fetch_surface(raw, ray, raw.t * bounce_cone_spread, TEXTURE_TEXEL);
    if (!shows_cache_bias())
        path.radiance += path.throughput * count_emission(path, bsdf, hit, pixel_random);
    if ((hit.flags & MATERIAL_SKY) != 0u || path.vertex >= bounce_count())
        return false;
    path.surface = hit.surface;
    path.met = hit.surface.position;
    path.cluster = hit.cluster;
    path.vertex += 1u;
    cached = find_cached_light(hit);
    path.guide = cached.guide;
    return true;
}

// What the path of a pixel has found.
struct FoundLight {
    vec3 radiance;
    vec3 direction; // where the first ray went
    float pdf; // the density that it was drawn with; 0: nothing was found
    float specular_hit_distance;
};
const FoundLight nothing_found = FoundLight(vec3(0.0), vec3(0.0), 0.0, -1.0);

const uint first_guide_dimension
    = 10u; // in the first bounce's block, behind those of the BSDF sample and of the light where it ends
// Of the first rays, where there are guides.
const float guided_share = 0.125;

// The path's next ray, as sample_bsdf draws it or towards a guide.
struct NextRay {
    BsdfSample bsdf; // its density that of BSDF rays
    GuideSample aim;
};

NextRay choose_next_ray(BouncePath path, Guides guides, bool to_guide, Random random)
{
    NextRay next;
    next.aim = GuideSample(0u, vec3(0.0), 0.0);
    random.dimension += to_guide ? first_guide_dimension + 2u : 0u;
    vec2 xi = next_vec2(random);
    if (to_guide) {
        next.aim = sample_guide(guides, path.surface, xi);
        next.bsdf.direction = next.aim.direction;
        next.bsdf.lobe = BSDF_LOBE_DIFFUSE;
    } else {
        next.bsdf.direction = sample_bsdf_direction(path.surface, xi, next_float(random), next.bsdf.lobe);
    }
    next.bsdf.pdf = pdf_bsdf(path.surface, next.bsdf.direction);
    next.bsdf.value = evaluate_bsdf(path.surface, next.bsdf.direction);
    return next;
}

// The share of what the first ray found that is counted for it: both ways to meet a guide's cell share it by MIS, and a
// ray that was aimed at one and met something else has found nothing.
float share_with_other_way(Guides guides, Surface primary, BouncePath path, bool to_guide, NextRay first)
{
    if (guides.count == 0u || path.guide == 0u)
        return to_guide ? 0.0 : 1.0;
    float aimed = pdf_guide(guides, primary, path.guide, path.met);
    float by_chance = first.bsdf.pdf * (1.0 - guided_share);
    if (!to_guide)
        return mis_weight(by_chance, aimed * guided_share);
    // By the density of the place that was met: rounding may have brought the ray to the next cell.
    return path.guide == first.aim.guide && aimed > 0.0
        ? mis_weight(aimed * guided_share, by_chance) * first.aim.pdf / aimed
        : 0.0;
}

// Chooses a guide, and whether the first ray is aimed at it.
Guides choose_guide(PrimarySurface primary, Random pixel_random, out bool to_guide)
{
    Guides guides = no_guides;
    to_guide = false;
#ifndef VKPT_SAMPLER_MIS // whose rays share the emitters that they meet with light sampling, by the density of BSDF
                         // rays
    Random random = random_for_bounce(pixel_random, 2u);
    random.dimension += first_guide_dimension;
    vec2 xi = next_vec2(random);
    guides = open_guides(primary.surface, primary.cluster, xi.x);
    to_guide = guides.total > 0.0 && xi.y < guided_share;
#endif
    return guides;
}

FoundLight follow_path(uvec2 pixel, uint index, PrimarySurface primary)
{
    Random pixel_random = random_of_pixel(pixel, index);
    bool to_guide;
    Guides guides = choose_guide(primary, pixel_random, to_guide);
    BouncePath path
        = BouncePath(primary.surface, primary.cluster, 0u, vec3(1.0), vec3(0.0), -1.0, vec3(0.0), 0u, false);
    FoundLight found = nothing_found;
    float share = 1.0;
    ROLLED_FOR (uint bounce = 0u; bounce < bsdf_ray_count(); bounce++) {
        bool is_aimed = to_guide && bounce == 0u;
        NextRay next = choose_next_ray(path, guides, is_aimed, random_for_bounce(pixel_random, bounce + 2u));
        float pdf = is_aimed ? next.aim.pdf : next.bsdf.pdf;
        if (pdf <= 0.0)
            break;
        if (bounce == 0u) {
            found.direction = next.bsdf.direction;
            found.pdf = pdf * (guides.total <= 0.0 ? 1.0 : to_guide ? guided_share : 1.0 - guided_share);
        } else {
            path.throughput *= reflected_radiance(path.surface, next.bsdf.value, vec3(1.0)) / pdf;
        }
        CachedLight cached;
        bool goes_on = bounce_path(path, next.bsdf, pixel_random, cached);
        if (bounce == 0u) {
            share = share_with_other_way(guides, primary.surface, path, to_guide, next);
            if (next.bsdf.lobe == BSDF_LOBE_SPECULAR)
                found.specular_hit_distance = path.ray_length;
        }
        if (!goes_on || share == 0.0)
            break;
        path.radiance += path.throughput * reflect_direct_light(path, cached, pixel_random);
        // The last says nothing new: compilers that know the number drop the loop.
        if (bsdf_ray_count() == 1u)
            break;
    }
    add_traced_rays(index);
    found.radiance = path.radiance * (share * limit_radiance(path.radiance));
    return found;
}

void add_light(uint index, Surface s, FoundLight found, float scale)
{
    store_specular_hit_distance(index, found.specular_hit_distance);
    bool bias_alone = shows_cache_bias();
    if (found.pdf <= 0.0 && !bias_alone)
        return;
    ReflectedLight light = bias_alone ? no_reflected_light : fetch_reflected_light(index);
    if (found.pdf > 0.0) {
        BsdfValue reflected = evaluate_bsdf(s, found.direction);
        vec3 radiance = found.radiance * (scale / found.pdf);
        light.diffuse += reflected.diffuse * radiance;
        light.specular += reflected.specular * radiance;
    }
    store_reflected_light(index, light);
}

// Narrower lobes reflect something else one pixel on: such surfaces send rays of their own.
const float min_shared_roughness = 0.2;
bool sends_own_rays(PrimarySurface p) { return p.surface.roughness < min_shared_roughness; }

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
    ReprojectionQuery query
        = make_query(load_features(index), unpack_upper_halves(load_depth_gradient(index)), fetch_place(index));
    return shows_surface(query, nearest_in_last_view(query.shown.xy), there);
}

// Whether the block has no history: what its pixels share would stand out as specks then. Beside an edge, or of a thin
// thing, one of two opposite pixels may have one.
bool is_new(BounceBlock block)
{
    if ((frame.flags & FRAME_HISTORY) == 0u)
        return true;
    bool seen = false;
    ROLLED_FOR (uint i = 0u; i < 2u && !seen; i++)
        seen = was_seen(pixel_of_block(block, i == 0u ? 0u : bounce_block_pixels() - 1u));
    return !seen;
}

// Whether the same light falls on two neighbouring pixels, and their lobes are alike.
bool are_alike(PrimarySurface a, PrimarySurface b)
{
    const float min_cosine = 0.97, max_roughness_difference = 0.1, max_off_plane = 0.008; // of the depth
    vec3 way = b.surface.position - a.surface.position;
    float off = max(abs(dot(way, a.surface.geometric_normal)), abs(dot(way, b.surface.geometric_normal)));
    return a.depth >= 0.0 && b.depth >= 0.0 && !sends_own_rays(a) && !sends_own_rays(b)
        && off <= max_off_plane * min(a.depth, b.depth) && dot(a.surface.normal, b.surface.normal) >= min_cosine
        && abs(a.surface.roughness - b.surface.roughness) <= max_roughness_difference
        && abs(a.surface.metallic - b.surface.metallic) < 0.5;
}

// A bit for each pixel of the block that takes over what its leader finds, the leader included; 0: nobody does.
uint find_alike(BounceBlock block)
{
    PrimarySurface leader;
    uint alike = 0u;
    ROLLED_FOR (uint i = 0u; i < bounce_block_pixels(); i++) {
        PrimarySurface primary = load_block_surface(pixel_of_block(block, i));
        if (i == 0u)
            leader = primary;
        alike |= are_alike(leader, primary) ? 1u << i : 0u;
    }
    return alike;
}

// Adds what a path found to the pixels of the block whose bit is set.
void light_pixels(BounceBlock block, uint bits, FoundLight found, float scale)
{
    ROLLED_FOR (uint i = 0u; i < bounce_block_pixels(); i++) {
        uint index = pixel_index(pixel_of_block(block, i));
        if ((bits >> i & 1u) != 0u)
            add_light(index, load_primary_surface(index).surface, found, scale);
    }
}

// The leader's path, and those of pixels that do not share. What the leader found goes to the pixels that are like it,
// as if each had sent the ray. Who has fewer of its kind in the block is lit more seldom, as those have fewer turns to
// lead, and the more when it is: the mean stays. Where the last view did not show what the block does, all go their own
// way.
void light_block(uvec2 number, uint)
{
    BounceBlock block = open_bounce_block(number);
    uint pixels = bounce_block_pixels();
    bool shares = pixels > 1u && !is_new(block);
    uint alike = shares ? find_alike(block) : 0u;
    float scale = alike != 0u ? float(pixels) / float(bitCount(alike)) : 1.0;
    ROLLED_FOR (uint i = 0u; i < pixels; i++) {
        uvec2 pixel = pixel_of_block(block, i);
        uint index = pixel_index(pixel);
        PrimarySurface primary = load_block_surface(pixel);
        bool leads = i == 0u, alone = !shares || sends_own_rays(primary);
        if (primary.depth >= 0.0) {
            if (leads || alone) {
                FoundLight found = follow_path(pixel, index, primary);
                light_pixels(block, leads ? max(alike, 1u) : 1u << i, found, leads ? scale : 1.0);
            } else if ((alike >> i & 1u) == 0u) {
                store_specular_hit_distance(index, -1.0);
            }
            // Others' light, and more than its own, is no sample of the pixel that could be repeated.
            bool own_sample = alone || (leads && scale == 1.0);
            if (!own_sample && (frame.flags & FRAME_REPLAYED) != 0u)
                store_random_seed(index, no_random_seed);
        }
    }
}

VKPT_RUN_OVER_BLOCKS(light_block)
