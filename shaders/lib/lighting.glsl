// SPDX-License-Identifier: GPL-2.0-or-later
// Next event estimation: one light chosen by the light sampler that this pass was built with, one point on it, one
// shadow ray. With samplers that say so, MIS: the ray that goes on from the surface anyway counts the emitters that it
// meets, and both ways to find a point share its light by mis_weight. VKPT_SAMPLER_MIS is defined for those samplers
// alone (shaders/CMakeLists.txt, from their traits): drivers put every call in line before they find out that a
// constant condition never holds, and a third of the code would be that.
#ifndef VKPT_LIB_LIGHTING
#define VKPT_LIB_LIGHTING

#include "filtered_rays.glsl"
#include "light_choice.glsl"
#include "reflected_light.glsl"
// First surfaces' lights are also weighed by what earlier shadow rays tell of them. At the ends of bounce rays that
// would gain next to nothing.
#if defined(VKPT_LIGHTS_FIRST_SURFACES) && defined(VKPT_SAMPLER_WEIGHS_VISIBILITY)
#define VKPT_USES_VISIBILITY
#include "light_visibility.glsl"
#endif

#ifdef VKPT_LIGHT_PASSES_OWN_BODY
const uint mask_shadow = MASK_OPAQUE | MASK_ALPHA_TEST | MASK_SKY;
#else
const uint mask_shadow = MASK_OPAQUE | MASK_ALPHA_TEST | MASK_OWN_BODY | MASK_SKY;
#endif

// The lights of a cluster. For a sample of the last view that is repeated: with the last view's lights at their old
// places.
LightListView open_light_list_for(LightRandom random, int cluster)
{
    LightTables tables = light_tables();
    if (frame.scene.repeated_lists == 0ul || random.more.frame == frame.frame_index)
        return open_light_list(tables, cluster);
    tables.lists = LightListBuffer(frame.scene.repeated_lists);
    tables.dynamic_indices = LightIndexBuffer(frame.scene.repeated_light_indices);
    return open_repeated_list(tables, cluster, LightIndexBuffer(frame.scene.previous_list_lengths));
}

layout(constant_id = BOUNCES_CONSTANT) const int fixed_bounces = NOT_FIXED;

// pt_bounces
uint bounce_count() { return uint(fixed_bounces == NOT_FIXED ? frame.cvars.pt_bounces : fixed_bounces); }

// How many of a path's surfaces send out a BSDF ray. With MIS the first one always does: without bounces, for emission
// alone.
uint bsdf_ray_count() { return light_sampler_mis ? max(bounce_count(), 1u) : bounce_count(); }

// What is left of the light that gets to the ray's origin. A sun's does where the first thing on the ray is the sky,
// not beyond: maps are closed, and behind their skies stand other rooms.
vec3 arriving_share(Ray shadow, bool from_sun)
{
    vec3 transmittance;
    RawHit hit = trace_filtered(shadow, mask_shadow, !from_sun, true, transmittance);
    if (!from_sun)
        return transmittance;
    if (hit.triangle == TRACE_MISS)
        return vec3(0.0);
    uint material = fetch_Triangle(frame.scene.triangles, hit.triangle).material;
    return (fetch_Material(frame.scene.materials, material).flags & MATERIAL_SKY) != 0u ? transmittance : vec3(0.0);
}

// The light that was chosen for a surface.
struct ChosenLight {
    uint lightstyle;
    vec3 direction; // to it
};

ReflectedLight sample_list(
    LightListView list, Surface s, LightRandom random, bool bsdf_ray_follows, out ChosenLight chosen)
{
    ReflectedLight result = no_reflected_light;
    chosen = ChosenLight(0u, vec3(0.0));
    LightOptions options = light_options();
#ifdef VKPT_USES_VISIBILITY
    uint visibility_row = find_visibility_row(s);
    options.hidden = load_hidden_lights(visibility_row);
#endif
    LightSample light = sample_light(list, s, random, options);
    if (light.emitter < 0)
        return result;
    Emitter emitter = load_emitter(list, uint(light.emitter));
    chosen.lightstyle = emitter.lightstyle;
    if (emitter.radiance == vec3(0.0))
        return result;
    EmitterSample point = sample_emitter_point(emitter, s, light.point, options);
    if (point.pdf <= 0.0)
        return result;
    chosen.direction = point.direction;
    BsdfValue bsdf = evaluate_bsdf(s, point.direction);
    if (bsdf.diffuse <= 0.0 && bsdf.specular == vec3(0.0))
        return result;
    vec3 radiance = point.radiance;
    if (emitter.type == EMITTER_SKY)
        radiance = sky_radiance(point.direction);
    // Up to shortly before the emitter: its own surface must not shadow it.
    vec3 origin = offset_ray_origin(s.position, s.geometric_normal);
    vec3 to_light = point.point - origin;
    float distance = length(to_light);
    Ray shadow = Ray(origin, to_light / distance, 0.0, distance - quick_max(0.02, distance * 1e-4));
    vec3 arriving = arriving_share(shadow, emitter.type == EMITTER_SUN);
#ifdef VKPT_USES_VISIBILITY
    count_shadow_ray(visibility_row, uint(light.emitter), random.more, arriving);
#endif
    radiance *= arriving;
    if (radiance == vec3(0.0))
        return result;
    float density = point.pdf * light.probability;
#ifdef VKPT_SAMPLER_MIS
    if (bsdf_ray_follows && is_met_by_rays(emitter))
        density /= mis_weight(density, pdf_bsdf(s, point.direction));
#endif
    vec3 incoming = radiance / density;
    result.diffuse = bsdf.diffuse * incoming;
    result.specular = bsdf.specular * incoming;
    return result;
}

ReflectedLight sample_list(LightListView list, Surface s, LightRandom random, bool bsdf_ray_follows)
{
    ChosenLight chosen;
    return sample_list(list, s, random, bsdf_ray_follows, chosen);
}

// `bsdf_ray_follows`: a ray drawn by sample_bsdf leaves `s`, and its part is counted elsewhere (weigh_met_emitter).
ReflectedLight sample_lights(LightListView list, Surface s, LightRandom random, bool bsdf_ray_follows)
{
#ifdef VKPT_SAMPLER_NEWCOMERS_APART
    ReflectedLight sum = no_reflected_light;
    uint parts = has_newcomers(list) ? 2u : 1u;
    ROLLED_FOR (uint i = 0u; i < parts; i++) {
        ReflectedLight part
            = sample_list(i == 0u ? counted_lights(list) : newcomers(list), s, random, bsdf_ray_follows);
        sum.diffuse += part.diffuse;
        sum.specular += part.specular;
    }
    return sum;
#else
    return sample_list(list, s, random, bsdf_ray_follows);
#endif
}

ReflectedLight sample_direct_light(Surface s, int cluster, LightRandom random, bool bsdf_ray_follows)
{
    return sample_lights(open_light_list_for(random, cluster), s, random, bsdf_ray_follows);
}

// The share, by MIS, of the light of an emitter that a BSDF ray of density `bsdf_pdf` from `s` met at `point`; `random`
// and `s` are those of sample_direct_light. 1 where light sampling cannot find it: it is in no list. 0 where light
// sampling alone accounts for it.
float weigh_met_emitter(Surface s, int cluster, LightRandom random, uint emitter, vec3 point, float bsdf_pdf)
{
    LightListView list = open_light_list_for(random, cluster);
    Emitter e = load_emitter(list, emitter);
    if (!is_met_by_rays(e))
        return 0.0;
    LightOptions options = light_options();
    float probability = light_probability(list, s, emitter, random, options);
    return mis_weight(bsdf_pdf, probability * pdf_emitter_point(e, s, point, options));
}

#endif
