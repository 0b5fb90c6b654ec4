// SPDX-License-Identifier: GPL-2.0-or-later
// All tracing of the renderer goes through trace_nearest and trace_visible. Both know alpha-tested triangles; masks are
// MASK_* of shared/scene.h. Behind them stands one backend: the software BVH.
#ifndef VKPT_LIB_TRACE
#define VKPT_LIB_TRACE

#include "frame.glsl"
#include "trace_software.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TriangleBuffer { Triangle v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MaterialBuffer { Material v[]; };

struct Ray {
    vec3 origin;
    vec3 direction; // unit
    float t_min;
    float t_max;
};

const float ray_far = 1e6;
// How many transparent alpha-tested triangles in a row a ray passes.
const uint max_alpha_layers = 16u;

// The nearest triangle (with any_hit: some triangle) of the masked ones, alpha taken for opaque.
RawHit trace_triangles(Ray ray, uint mask, bool any_hit)
{
    // Not gl_WorkGroupSize: it is only known behind the layout(local_size_x) of the including pass, and 1 before it.
    uint lane = gl_WorkGroupID.x * PIXEL_GROUP_SIZE + gl_LocalInvocationIndex;
    uint64_t stack = software_stack(frame.scene.trace_stack, lane);
    RawHit hit = software_miss(ray.t_max);
    [[dont_unroll]] for (uint tree = 0u; tree < frame.scene.tree_count; tree++) {
        software_trace(frame.scene.trees[tree], ray.origin, ray.direction, ray.t_min, hit, mask, any_hit, stack);
        if (any_hit && hit.triangle != TRACE_MISS)
            break;
    }
    return hit;
}

vec2 interpolate_uv(Triangle triangle, vec2 barycentrics)
{
    return triangle.uvs[0] * (1.0 - barycentrics.x - barycentrics.y) + triangle.uvs[1] * barycentrics.x
        + triangle.uvs[2] * barycentrics.y;
}

bool is_cut_out(RawHit hit)
{
    Triangle triangle = TriangleBuffer(frame.scene.triangles).v[hit.triangle];
    Material material = MaterialBuffer(frame.scene.materials).v[triangle.material];
    if ((material.flags & MATERIAL_ALPHA_TEST) == 0u)
        return false;
    vec2 uv = interpolate_uv(triangle, hit.barycentrics) + material.uv_scroll;
    return textureLod(sampler2D(textures[nonuniformEXT(material.texture)], samplers[SAMPLER_REPEAT]), uv, 0.0).a < 0.5;
}

// hit.triangle is TRACE_MISS where nothing was met.
RawHit trace_nearest(Ray ray, uint mask)
{
    RawHit hit = trace_triangles(ray, mask, false);
    if ((frame.flags & FRAME_ALPHA_TEST) != 0u)
        [[dont_unroll]] for (uint layer = 0u; layer < max_alpha_layers; layer++) {
            if (hit.triangle == TRACE_MISS || !is_cut_out(hit))
                break;
            ray.t_min = hit.t * (1.0 + 1e-5) + 1e-3;
            hit = trace_triangles(ray, mask, false);
        }
    return hit;
}

// Whether nothing of the masked triangles lies on the ray between t_min and t_max.
bool trace_visible(Ray ray, uint mask)
{
    if ((frame.flags & FRAME_ALPHA_TEST) != 0u)
        return trace_nearest(ray, mask).triangle == TRACE_MISS;
    return trace_triangles(ray, mask, true).triangle == TRACE_MISS;
}

#endif
