// SPDX-License-Identifier: GPL-2.0-or-later
// All tracing of the renderer goes through trace_nearest and trace_visible. Masks are MASK_* of shared/scene.h;
// alpha-tested triangles are met where their texture has no hole; both sides of a triangle are met. Behind the two
// functions stands the backend that the pass is compiled for (shaders/CMakeLists.txt defines one of VKPT_TRACE_*): each
// brings search_ray().
#ifndef VKPT_LIB_TRACE
#define VKPT_LIB_TRACE

#include "alpha_test.glsl"
#include "frame.glsl"
#include "ray.glsl"

#if defined(VKPT_TRACE_SOFTWARE)
#include "search_software.glsl"
#elif defined(VKPT_TRACE_QUERY)
#include "search_query.glsl"
#elif defined(VKPT_TRACE_PIPELINE)
#include "search_pipeline.glsl"
#endif

// A pass that does not trace is compiled without a backend.
#if defined(VKPT_TRACE_SOFTWARE) || defined(VKPT_TRACE_QUERY) || defined(VKPT_TRACE_PIPELINE)

// Of this invocation since it was last asked.
uint traced_rays = 0u;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer RayCountsBuffer { RayCounts v; };

void count_ray(bool visibility)
{
    traced_rays += 1u;
    if ((frame.flags & FRAME_COUNT_RAYS) == 0u)
        return;
    RayCountsBuffer counts = RayCountsBuffer(frame.ray_counts);
    if (visibility)
        atomicAdd(counts.v.visible, 1u);
    else
        atomicAdd(counts.v.nearest, 1u);
}

// hit.triangle is TRACE_MISS where nothing was met.
RawHit trace_nearest(Ray ray, uint mask)
{
    count_ray(false);
    return search_ray(ray, mask, false);
}

// Whether nothing of the masked triangles lies on the ray between t_min and t_max.
bool trace_visible(Ray ray, uint mask)
{
    count_ray(true);
    return search_ray(ray, mask, true).triangle == TRACE_MISS;
}

// What this invocation has traced is the first that is counted for a pixel; it begins to count anew.
void store_traced_rays(uint index)
{
    if (frame.cvars.pt_debug_view == DEBUG_VIEW_RAYS)
        store_ray_count(index, traced_rays);
    traced_rays = 0u;
}

// The same, added to what is counted.
void add_traced_rays(uint index)
{
    if (frame.cvars.pt_debug_view == DEBUG_VIEW_RAYS)
        store_ray_count(index, load_ray_count(index) + traced_rays);
    traced_rays = 0u;
}

#endif

#endif
