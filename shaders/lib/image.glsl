// SPDX-License-Identifier: GPL-2.0-or-later
// The image's radiance on its way from the passes that make it to anti-aliasing, or to the average.
#ifndef VKPT_LIB_IMAGE
#define VKPT_LIB_IMAGE

#include "packing.glsl"

// temporal_antialiasing stores `accumulated` itself, perhaps at another size.
void store_image(uint index, vec3 radiance)
{
    if ((frame.flags & FRAME_ANTIALIASED) != 0u) {
        store_composed(index, pack_light3(radiance));
        return;
    }
    float share = 1.0 / float(frame.accumulated_frames + 1u);
    vec3 before = frame.accumulated_frames > 0u ? load_accumulated(index).rgb : vec3(0.0);
    store_accumulated(index, vec4(before + (radiance - before) * share, 0.0));
}

#endif
