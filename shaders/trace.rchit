#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Backend "pipeline": what the nearest hit is.
#include "lib/frame.glsl"
#include "lib/ray.glsl"
#include "lib/structure.glsl"
#extension GL_EXT_ray_tracing : require

layout(location = 0) rayPayloadInEXT RawHit traced_hit;
hitAttributeEXT vec2 barycentrics;

void main()
{
    traced_hit.triangle = triangle_id(gl_InstanceCustomIndexEXT, gl_PrimitiveID);
    traced_hit.t = gl_HitTEXT;
    traced_hit.barycentrics = barycentrics;
    traced_hit.front = gl_HitKindEXT == gl_HitKindFrontFacingTriangleEXT ? 1u : 0u;
}
