#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// How bright it is where the player stands, for the monsters' eyes (r_lightlevel): direct light on the floor below the eye.
#include "lib/frame.glsl"
#include "lib/lighting.glsl"

layout(local_size_x = PIXEL_GROUP_SIZE) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer LightLevelBuffer { float v; };

// Each lane takes so many samples.
const uint samples_per_lane = 4u;

shared float sums[PIXEL_GROUP_SIZE];

float sample_floor(Surface surface, int cluster)
{
    float sum = 0.0;
    [[dont_unroll]] for (uint i = 0u; i < samples_per_lane; i++) {
        Random random = make_random(uvec2(gl_LocalInvocationIndex, i), frame.frame_index, frame.seed);
        sum += luminance(sample_direct_light(surface, cluster, random).diffuse);
    }
    return sum / float(samples_per_lane);
}

void main()
{
    uint lane = gl_LocalInvocationIndex;
    Ray down = Ray(frame.camera.eye, vec3(0.0, 0.0, -1.0), 0.0, ray_far);
    RawHit raw = trace_nearest(down, MASK_OPAQUE);
    sums[lane] = 0.0;
    if (raw.triangle != TRACE_MISS) {
        HitSurface hit = fetch_surface(raw, down, 1.0);
        sums[lane] = sample_floor(hit.surface, hit.cluster) + luminance(hit.emission);
    }
    barrier();
    if (lane != 0u)
        return;
    float total = 0.0;
    for (uint i = 0u; i < PIXEL_GROUP_SIZE; i++)
        total += sums[i];
    LightLevelBuffer(frame.light_level).v = total / float(PIXEL_GROUP_SIZE);
}
