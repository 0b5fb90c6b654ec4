#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Light that reaches the primary surface straight from an emitter.
#define VKPT_LIGHTS_FIRST_SURFACES
#include "lib/frame.glsl"
#include "lib/lighting.glsl"
#include "lib/reprojection.glsl"

void light_pixel(uvec2 pixel, uint index)
{
    ReflectedLight light = no_reflected_light;
    PrimarySurface primary = load_primary_surface(index);
    if (primary.depth >= 0.0) {
        LightRandom random = light_random(random_of_pixel(pixel, index), 0u);
        light = sample_direct_light(primary.surface, primary.cluster, random, bsdf_ray_count() > 0u);
        add_traced_rays(index);
    }
    store_reflected_light(index, light);
}

VKPT_RUN_OVER_PIXELS(light_pixel)
