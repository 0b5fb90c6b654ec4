// SPDX-License-Identifier: GPL-2.0-or-later
// Reads what is believed of the lights' visibility around a surface, and counts shadow rays for it. See
// shared/light_visibility.h.
#ifndef VKPT_LIB_LIGHT_VISIBILITY
#define VKPT_LIB_LIGHT_VISIBILITY

#include "frame.glsl"
#include "random.glsl"
#include "surfaces.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer VisibilityCounts { uint v[]; };

// The row of the patch that a surface lies in: a cube of space and one of 26 directions of its normal, so that
// walls have none in common with the floor. A little in front of the surface, as most lie on the cubes' sides.
uint find_visibility_row(Surface s)
{
    const float in_front = 0.05;
    ivec3 cube = whole_to_int(floor(s.position * (1.0 / VISIBILITY_PATCH) + s.geometric_normal * in_front));
    uvec3 side = uvec3(whole_to_int(s.geometric_normal)) & 3u;
    // Maps are at most 8,192 units wide, 256 cubes.
    uvec3 place = uvec3(cube) & 255u | side << 8u;
    return hash_word(place.x | place.y << 10u | place.z << 20u) % VISIBILITY_ROWS;
}

// LightOptions::hidden of a row.
uvec4 load_hidden_lights(uint row)
{
    LightVisibilityView table = frame.scene.visibility;
    return table.rows != 0ul ? load_element(table.rows, row, uvec4(0u)) : uvec4(0u);
}

// Counts the shadow ray of a pixel's surface to a light. Not that of a sample which is repeated.
void count_shadow_ray(uint row, uint emitter, Random pixel_random, vec3 arriving)
{
    LightVisibilityView table = frame.scene.visibility;
    uvec2 tile = pixel_random.pixel / 4u;
    uint turn = hash_word((tile.x | tile.y << 16u) + frame.frame_index * 0x9e3779b9u);
    if (table.rows != 0ul && emitter < table.static_emitters && (turn & table.counted_tiles) == 0u
        && pixel_random.frame == frame.frame_index)
        atomicAdd(VisibilityCounts(table.counts).v[row * VISIBILITY_SLOTS + emitter % VISIBILITY_SLOTS],
            luminance(arriving) > 0.5 ? VISIBILITY_ARRIVED : VISIBILITY_BLOCKED);
}

#endif
