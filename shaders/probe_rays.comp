#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Traces a list of rays, one per pixel, and writes what each met: for tests, benches, and the choice of a trace
// backend.
#include "lib/frame.glsl"
#include "lib/trace.glsl"
#include "shared/probes.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TracedRayBuffer { TracedRay v[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer TracedHitBuffer { TracedHit v[]; };

void trace_probe(uvec2 pixel, uint index)
{
    if (index >= frame.probe_count)
        return;
    TracedRay probe = TracedRayBuffer(frame.probes).v[index];
    Ray ray = Ray(probe.origin, probe.direction, probe.t_min, probe.t_max);
    RawHit hit;
    if ((frame.flags & FRAME_PROBE_VISIBILITY) != 0u) {
        hit = no_hit(ray.t_max);
        if (!trace_visible(ray, frame.probe_mask))
            hit.triangle = 0u;
    } else {
        hit = trace_nearest(ray, frame.probe_mask);
    }
    TracedHitBuffer(frame.probe_hits).v[index] = TracedHit(hit.triangle, hit.t, hit.barycentrics, hit.front);
}

VKPT_RUN_OVER_PIXELS(trace_probe)
