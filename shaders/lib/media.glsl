// SPDX-License-Identifier: GPL-2.0-or-later
// What liquids and glass take from what passes them.
#ifndef VKPT_LIB_MEDIA
#define VKPT_LIB_MEDIA

#include "../shared/liquid.h"
#include "frame.glsl"

vec3 medium_absorption(uint medium)
{
    if (medium == MEDIUM_NONE)
        return vec3(0.0);
    vec3 absorption = medium == MEDIUM_WATER ? WATER_ABSORPTION
        : medium == MEDIUM_SLIME             ? SLIME_ABSORPTION
                                             : LAVA_ABSORPTION;
    return absorption * frame.cvars.pt_water_density;
}

// Share of the light that is left behind `length` units of the medium (Beer and Lambert).
vec3 medium_transmittance(uint medium, float length)
{
    return medium == MEDIUM_NONE ? vec3(1.0) : exp(-medium_absorption(medium) * min(length, 8192.0));
}

// On the side that a ray came from which met a liquid's face. `face`: Triangle::medium; `front`: it met its front.
uint medium_before(uint face, bool front)
{
    return ((face & MEDIUM_IN_FRONT) != 0u) == front ? face & MEDIUM_MASK : MEDIUM_NONE;
}
uint medium_behind(uint face, bool front) { return medium_before(face, !front); }

// Of light that passes a pane, or a murky liquid's surface: of what is covered the texture's colour passes.
vec3 pane_transmittance(vec3 albedo, float opacity) { return 1.0 - opacity + opacity * albedo; }

#endif
