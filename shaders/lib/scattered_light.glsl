// SPDX-License-Identifier: GPL-2.0-or-later
// The buffer `scattered`: one element for 2 x 2 pixels, row by row; radiance, then the length that was
// looked along.
#ifndef VKPT_LIB_SCATTERED_LIGHT
#define VKPT_LIB_SCATTERED_LIGHT

#include "frame.glsl"

const float scattering_far = 4096.0; // where nothing is seen

// For a pixel from those around it: the mean of 3 x 3 elements, more of those that look about as far.
vec3 spread_scattered(uvec2 pixel, float depth)
{
    uvec2 size = (frame.size + 1u) / 2u;
    ivec2 centre = ivec2(pixel / 2u);
    float length = depth >= 0.0 ? min(depth, scattering_far) : scattering_far;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    ROLLED_FOR (int i = 0; i < 9; i++) {
        uvec2 at = uvec2(clamp(centre + ivec2(i % 3, i / 3) - 1, ivec2(0), ivec2(size) - 1));
        vec4 element = load_scattered(at.y * size.x + at.x);
        float off = abs(element.w - length) / (0.1 * length + 8.0), weight = 1.0 / (1.0 + off * off);
        sum += weight * element.rgb;
        weights += weight;
    }
    return sum / weights;
}

#endif
