#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Automatic exposure: the image's log-average luminance, without its darkest and brightest tails, becomes middle
// grey.
#include "lib/frame.glsl"
#include "lib/bsdf.glsl"

layout(local_size_x = 256) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ExposureBuffer { ExposureState v; };

const uint bin_count = 128u;
const float lowest_log2 = -12.0, highest_log2 = 12.0;
const uint max_samples = 32768u;
const float middle_grey = 0.18;
// Shares of the pixels that do not count.
const float dark_share = 0.4, bright_share = 0.05;
// How far exposure follows a dark or bright room: 1 would make all rooms look alike.
const float adaptation = 0.75;
const float reference_luminance = 0.25;

shared uint bins[bin_count];

void count_luminances()
{
    uint lane = gl_LocalInvocationID.x;
    if (lane < bin_count)
        bins[lane] = 0u;
    barrier();
    uvec2 size = frame.resolved_size;
    uint spacing = sample_spacing(size, max_samples);
    uvec2 samples = divide_whole(size + spacing - 1u, uvec2(spacing));
    for (uint i = lane; i < samples.x * samples.y; i += gl_WorkGroupSize.x) {
        uvec2 pixel = min(place_of_tile(i, samples.x) * spacing + spacing / 2u, size - 1u);
        float value = luminance(load_accumulated(pixel.y * size.x + pixel.x).rgb);
        float place = (log2(max(value, 1e-6)) - lowest_log2) / (highest_log2 - lowest_log2);
        atomicAdd(bins[floor_to_uint(clamp(place, 0.0, 0.999) * float(bin_count))], 1u);
    }
    barrier();
}

float average_log2()
{
    uint total = 0u;
    for (uint i = 0u; i < bin_count; i++)
        total += bins[i];
    float first = float(total) * dark_share, last = float(total) * (1.0 - bright_share);
    float passed = 0.0, sum = 0.0, weight = 0.0;
    for (uint i = 0u; i < bin_count; i++) {
        float count = float(bins[i]);
        float inside = max(min(passed + count, last) - max(passed, first), 0.0);
        sum += inside * (lowest_log2 + (float(i) + 0.5) / float(bin_count) * (highest_log2 - lowest_log2));
        weight += inside;
        passed += count;
    }
    return sum / max(weight, 1.0);
}

void main()
{
    // Views without a world are mostly nothing: models are shown in them as in ordinary light, whatever their share.
    bool has_world = (frame.flags & FRAME_NO_WORLD) == 0u;
    if (has_world)
        count_luminances();
    if (gl_LocalInvocationID.x != 0u)
        return;
    ExposureBuffer state = ExposureBuffer(frame.exposure);
    float measured = has_world ? average_log2() : log2(reference_luminance);
    // Nothing seen yet: start where the image is.
    float previous = state.v.valid != 0u ? state.v.adapted_log2 : measured;
    float adapted = mix(measured, previous, exp(-frame.frame_seconds * frame.cvars.pt_exposure_speed));
    float automatic = middle_grey / reference_luminance * exp2(-adaptation * (adapted - log2(reference_luminance)));
    float base = has_world && frame.cvars.pt_exposure > 0.0 ? frame.cvars.pt_exposure : clamp(automatic, 0.01, 100.0);
    state.v.adapted_log2 = adapted;
    state.v.valid = 1u;
    state.v.exposure = base * exp2(frame.cvars.pt_exposure_bias);
}
