// SPDX-License-Identifier: GPL-2.0-or-later
// Unit vectors on a square, whose sides go from -1 to 1 (the octahedral map; Cigolle et al., "A Survey of Efficient
// Representations for Independent Unit Vectors", JCGT 2014).
#ifndef VKPT_SHARED_OCTAHEDRAL_H
#define VKPT_SHARED_OCTAHEDRAL_H

#include "functions.h"

VKPT_SHARED_BEGIN
#ifdef __cplusplus
using glm::abs;
using glm::greaterThanEqual;
using glm::mix;
using glm::normalize;
#endif

// The octahedron's lower half, folded out.
VKPT_INLINE vec2 fold_octahedron(vec2 p)
{
    return (1.0f - abs(vec2(p.y, p.x))) * mix(vec2(-1.0f), vec2(1.0f), greaterThanEqual(p, vec2(0.0f)));
}

// Of any length but 0.
VKPT_INLINE vec2 direction_to_octahedron(vec3 direction)
{
    vec2 p = vec2(direction) / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    return direction.z < 0.0f ? fold_octahedron(p) : p;
}

VKPT_INLINE vec3 octahedron_to_direction(vec2 p)
{
    float z = 1.0f - abs(p.x) - abs(p.y);
    return normalize(vec3(z < 0.0f ? fold_octahedron(p) : p, z));
}

VKPT_SHARED_END

#endif
