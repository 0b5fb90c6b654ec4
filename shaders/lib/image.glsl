// SPDX-License-Identifier: GPL-2.0-or-later
// The image's radiance on its way from the passes that make it to anti-aliasing, or to the average.
#ifndef VKPT_LIB_IMAGE
#define VKPT_LIB_IMAGE

#include "packing.glsl"

// Set in the second word of `emitted`, and then of `layers` and `composed`, where what the pixel emits is the mean over
// several camera rays (antialiasing/supersample_lamps.comp).
const uint is_supersampled = 0x80000000u;

// The image stands still where it moves by less in a frame.
const float resting_pixels = 0.025;

// temporal_antialiasing stores `accumulated` itself, perhaps at another size. `marks`: is_supersampled or 0.
void store_image(uint index, vec3 radiance, uint marks)
{
    if ((frame.flags & FRAME_ANTIALIASED) != 0u) {
        store_composed(index, pack_light3(radiance) | uvec2(0u, marks));
        return;
    }
    float share = 1.0 / float(frame.accumulated_frames + 1u);
    vec3 before = frame.accumulated_frames > 0u ? load_accumulated(index).rgb : vec3(0.0);
    store_accumulated(index, vec4(before + (radiance - before) * share, 0.0));
}

// Of the last image, after anti-aliasing; beyond its edge the pixel at the edge.
uvec2 load_last_resolved(ivec2 pixel)
{
    uvec2 at = uvec2(clamp(pixel, ivec2(0), ivec2(frame.resolved_size) - 1));
    return load_previous_resolved(at.y * frame.resolved_size.x + at.x);
}

#endif
