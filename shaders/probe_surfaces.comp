#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Instead of primary_visibility: the surfaces to light are white, diffuse points from a list, one per pixel.
#include "lib/frame.glsl"
#include "lib/surfaces.glsl"
#include "shared/probes.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ProbeBuffer { IrradianceProbe v[]; };

void place_probe(uvec2 pixel, uint index)
{
    store_emitted(index, pack_floats3(vec3(0.0)));
    store_throughput(index, pack_light3(vec3(1.0)));
    store_position(index, vec4(0.0, 0.0, 0.0, -1.0));
    if (index >= frame.probe_count)
        return;
    IrradianceProbe probe = ProbeBuffer(frame.probes).v[index];
    HitSurface hit;
    hit.surface.position = probe.position;
    hit.surface.normal = hit.surface.geometric_normal = hit.surface.view = normalize(probe.normal);
    hit.surface.albedo = vec3(1.0);
    hit.surface.roughness = 1.0;
    hit.surface.metallic = 0.0;
    hit.surface.coat_loss = 0.0;
    hit.cluster = find_cluster(BspTreeBuffer(frame.scene.bsp_tree), offset_ray_origin(probe.position, probe.normal));
    store_position(index, vec4(probe.position, 0.0));
    store_surface(index, hit);
}

VKPT_RUN_OVER_PIXELS(place_probe)
