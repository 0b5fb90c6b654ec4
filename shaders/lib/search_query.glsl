// SPDX-License-Identifier: GPL-2.0-or-later
// Backend "query": the device's own ray tracing from compute shaders (VK_KHR_ray_query).
#ifndef VKPT_LIB_SEARCH_QUERY
#define VKPT_LIB_SEARCH_QUERY

#extension GL_EXT_ray_query : require

#include "alpha_test.glsl"
#include "structure.glsl"

// Triangles that cannot have holes are marked opaque in the structure and are no candidates here.
RawHit search_ray(Ray ray, uint mask, bool any_hit)
{
    rayQueryEXT query;
    Ray legal = legal_ray(ray);
    rayQueryInitializeEXT(query, accelerationStructureEXT(frame.scene.structure),
        any_hit ? gl_RayFlagsTerminateOnFirstHitEXT : gl_RayFlagsNoneEXT, mask, legal.origin, legal.t_min,
        legal.direction, legal.t_max);
    while (rayQueryProceedEXT(query)) {
        uint id = triangle_id(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false),
            rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
        if (!is_cut_out(id, rayQueryGetIntersectionBarycentricsEXT(query, false)))
            rayQueryConfirmIntersectionEXT(query);
    }
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT)
        return no_hit(ray.t_max);
    RawHit hit;
    hit.triangle = triangle_id(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
        rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    hit.t = rayQueryGetIntersectionTEXT(query, true);
    hit.barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, true);
    hit.front = rayQueryGetIntersectionFrontFaceEXT(query, true) ? 1u : 0u;
    return hit;
}

#endif
