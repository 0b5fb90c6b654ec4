// SPDX-License-Identifier: GPL-2.0-or-later
// The random numbers of a pixel of the image, as pt_noise wants them. After frame.glsl.
#ifndef VKPT_LIB_PIXEL_RANDOM
#define VKPT_LIB_PIXEL_RANDOM

#include "random.glsl"

// Probes are not neighbours in an image, and where many stand at one place their numbers must not repeat with the
// masks.
Random make_pixel_random_of(uvec2 pixel, uint frame_index)
{
    if (frame.cvars.pt_noise == NOISE_WHITE || (frame.flags & FRAME_PROBES) != 0u)
        return make_random(pixel, frame_index, frame.seed);
    return make_blue_random(BlueNoiseBuffer(frame.blue_noise), pixel, frame_index, frame.seed);
}

Random make_pixel_random(uvec2 pixel) { return make_pixel_random_of(pixel, frame.frame_index); }

#endif
