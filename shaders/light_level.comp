#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// How bright it is where the player stands, for the monsters' eyes (r_lightlevel): direct light on the floor below the
// eye.
#define VKPT_ALWAYS_RIS
#define VKPT_LIGHT_PASSES_OWN_BODY // the light that falls on the player is wanted, not what the player leaves of it
#include "lib/frame.glsl"
#include "lib/lighting.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LightLevelBuffer { float v[]; };

// Each lane takes so many samples; the CPU averages the lanes.
const uint samples_per_lane = 4u;

float sample_floor(Surface surface, int cluster, uint lane)
{
    float sum = 0.0;
    ROLLED_FOR (uint i = 0u; i < samples_per_lane; i++) {
        LightRandom random = light_random(make_random(uvec2(lane, i), frame.frame_index, frame.seed), 0u);
        sum += luminance(sample_direct_light(surface, cluster, random, false).diffuse);
    }
    return sum / float(samples_per_lane);
}

void look_down(uint lane)
{
    Ray down = Ray(frame.camera.eye, vec3(0.0, 0.0, -1.0), 0.0, ray_far);
    RawHit raw = trace_nearest(down, MASK_OPAQUE);
    float level = 0.0;
    if (raw.triangle != TRACE_MISS) {
        HitSurface hit = fetch_surface(raw, down, 1.0, TEXTURE_SMOOTH);
        level = sample_floor(hit.surface, hit.cluster, lane) + luminance(hit.emission);
    }
    LightLevelBuffer(frame.light_level).v[lane] = level;
}

VKPT_RUN_OVER_LANES(look_down)
