// SPDX-License-Identifier: GPL-2.0-or-later
// Backend "pipeline": the device's own ray tracing from ray generation shaders (VK_KHR_ray_tracing_pipeline). What a
// ray meets is told by trace.rchit, trace.rahit and trace.rmiss.
#ifndef VKPT_LIB_SEARCH_PIPELINE
#define VKPT_LIB_SEARCH_PIPELINE

#extension GL_EXT_ray_tracing : require

layout(location = 0) rayPayloadEXT RawHit traced_hit;

RawHit search_ray(Ray ray, uint mask, bool any_hit)
{
    // Stands where the first hit ends the search and no closest-hit shader runs; trace.rmiss says otherwise.
    traced_hit = RawHit(0u, ray.t_max, vec2(0.0), 0u);
    Ray legal = legal_ray(ray);
    traceRayEXT(accelerationStructureEXT(frame.scene.structure),
        any_hit ? gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT : gl_RayFlagsNoneEXT, mask, 0u,
        0u, 0u, legal.origin, legal.t_min, legal.direction, legal.t_max, 0);
    if (traced_hit.triangle == TRACE_MISS)
        traced_hit.t = ray.t_max;
    return traced_hit;
}

#endif
