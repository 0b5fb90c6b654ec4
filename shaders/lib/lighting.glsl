// SPDX-License-Identifier: GPL-2.0-or-later
// Next event estimation: one light chosen by the light sampler that this pass was built with, one point on it, one shadow ray.
#ifndef VKPT_LIB_LIGHTING
#define VKPT_LIB_LIGHTING

#include "surfaces.glsl"
#include "emitters.glsl"
#include "random.glsl"
#include "selected_light_sampler.glsl"

const uint mask_shadow = MASK_OPAQUE | MASK_ALPHA_TEST | MASK_OWN_BODY | MASK_SKY;

// Light that a surface reflects: diffuse without albedo.
struct ReflectedLight {
    vec3 diffuse;
    vec3 specular;
};

ReflectedLight sample_direct_light(Surface s, int cluster, INOUT(Random) random)
{
    ReflectedLight result = ReflectedLight(vec3(0.0), vec3(0.0));
    float xi_light = next_float(random);
    vec2 xi_point = next_vec2(random);
    LightListView list = open_light_list(light_tables(), cluster);
    LightSample light = sample_light(list, s, xi_light, uint(frame.cvars.pt_light_subset));
    if (light.emitter < 0)
        return result;
    Emitter emitter = load_emitter(list, uint(light.emitter));
    EmitterSample point = sample_emitter_point(emitter, s.position, xi_point);
    if (point.pdf <= 0.0)
        return result;
    BsdfValue bsdf = evaluate_bsdf(s, point.direction);
    if (bsdf.diffuse <= 0.0 && bsdf.specular == vec3(0.0))
        return result;
    vec3 radiance = point.radiance;
    if (emitter.type == EMITTER_SKY)
        radiance = sky_radiance(point.direction);
    // Up to shortly before the emitter: its own surface must not shadow it.
    vec3 origin = leave_surface(s.position, s.geometric_normal);
    vec3 to_light = point.point - origin;
    float distance = length(to_light);
    Ray shadow = Ray(origin, to_light / distance, 0.0, distance - max(0.02, distance * 1e-4));
    if (!trace_visible(shadow, mask_shadow))
        return result;
    vec3 incoming = radiance / (point.pdf * light.probability);
    result.diffuse = bsdf.diffuse * incoming;
    result.specular = bsdf.specular * incoming;
    return result;
}

#endif
