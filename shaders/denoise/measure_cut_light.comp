#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// For pt_info: how much of the light the denoiser's limit on fireflies takes, from some of the pixels. One workgroup:
// atomic additions for each pixel took denoise_temporal a quarter of its time on CPU drivers.
#include "../lib/frame.glsl"
#include "../lib/exposure.glsl"
#include "denoise.glsl"

layout(local_size_x = 256) in;

const uint max_samples = 1024u;

void main()
{
    uint spacing = sample_spacing(frame.size, max_samples);
    uvec2 samples = divide_whole(frame.size + spacing - 1u, uvec2(spacing));
    uvec2 shift = (hash_pcg4(uvec4(frame.frame_index, 0u, 0u, 0x3c6ef372u)).xy >> 16u) % spacing;
    float all = 0.0, cut = 0.0;
    for (uint i = gl_LocalInvocationID.x; i < samples.x * samples.y; i += gl_WorkGroupSize.x) {
        uvec2 pixel = place_of_tile(i, samples.x) * spacing + shift;
        if (!is_on_screen(pixel) || feature_depth(load_features(pixel_index(pixel))) <= 0.0)
            continue;
        vec2 lobes = luminances(fetch_reflected_light(pixel_index(pixel)));
        float light = lobes.x + lobes.y;
        // Samples of pt_indirect both may be negative, and broken light fails either comparison.
        light = light > 0.0 && light < 1e6 ? light : 0.0;
        all += light;
        cut += light * unpack_upper_halves(load_filter_reach(pixel_index(pixel)).y).y;
    }
    // So that the sums of all invocations have room.
    const float unit = 4096.0, most = 4e9 / float(gl_WorkGroupSize.x);
    uvec2 counted = uvec2(quick_min(vec2(all, cut) * image_exposure() * unit, vec2(most)));
    FrameStatisticsBuffer statistics = FrameStatisticsBuffer(frame.statistics);
    atomicAdd(statistics.v.sampled_light, counted.x);
    atomicAdd(statistics.v.cut_light, counted.y);
}
