#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Backend "pipeline": a ray that has met nothing.
#include "lib/frame.glsl"
#include "lib/ray.glsl"
#extension GL_EXT_ray_tracing : require

layout(location = 0) rayPayloadInEXT RawHit traced_hit;

void main() { traced_hit = no_hit(gl_RayTmaxEXT); }
