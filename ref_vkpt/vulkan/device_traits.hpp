// SPDX-License-Identifier: GPL-2.0-or-later
// What the renderer does in one way on GPUs and in another on Mesa's CPU driver. The values here are those of GPUs,
// lavapipe.cpp has the other ones; no other file asks what kind of device it is.
#pragma once

#include <cstdint>

namespace vkpt {

struct DeviceTraits {
    // r_anisotropic: a ray's footprint reads at most so many texels in a row. CPU drivers have no texture units.
    int max_texture_taps = 16;
    // pt_bounce_pixels auto: so many rows of two pixels share a bounce ray.
    uint32_t bounce_block_rows = 1;
    // Only Mesa's ray query depends on the order of triangles; sorting costs time every frame.
    bool sorts_triangles = false;
    // pt_trace auto measures the ways to trace, or takes "software": our own trees are 3 to 5 times as fast as Mesa's
    // ray query (docs/benchmarks.md), and measuring that costs seconds of compilation before the first texture.
    bool measures_traces = true;
    int trace_measurements = 5; // of each way; the median counts
    // GPUs need a million rays at once to be busy; a CPU traces one tile after the other.
    bool traces_in_parallel = true;
    // Queries are timed by timestamps: the way to a GPU and back takes as long as some thousand rays.
    bool has_distant_clock = true;
    // Passes leave marks in memory, which tell the last one before the device was lost.
    bool can_be_lost = true;
    // Pipelines are compiled for the values of cvars that change rarely. The CPU driver takes seconds to compile, and
    // reading the values costs it little.
    bool specializes_pipelines = true;
    // Shaders keep a lane's arrays private, load 16 bytes at once, and take a tile of pixels a workgroup:
    // shaders/lib/device/lanes.glsl.
    bool gpu_lanes = true;
    // Mesa keeps what it has compiled in a folder of ours; what is in there is not compiled ahead.
    bool keeps_compiled_shaders = false;
};

} // namespace vkpt
