#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Puts the picture's radiance together, the last level of the spatial filter included, and averages it with the frames before while
// nothing moves.
#define VKPT_DEVIATIONS_ARE_KNOWN
#include "lib/frame.glsl"
#include "lib/denoise_spread.glsl"
#include "lib/picture.glsl"

// What the surface reflects towards the viewer.
vec3 reflected_light(uvec2 pixel, uint index, Surface surface)
{
    if ((frame.flags & FRAME_DENOISED) == 0u) {
        ReflectedLight unfiltered = load_reflected_light(index);
        return surface.albedo * unfiltered.diffuse + unfiltered.specular;
    }
    FilteredLight light;
    if (frame.cvars.flt_denoiser == DENOISER_TEMPORAL)
        light = unpack_filtered(load_filtered(index));
    else
        light = spread_light(pixel, index, load_guide(index), load_element(push.source, index, uvec4(0u)));
    return surface.albedo * light.diffuse + specular_tint(surface) * light.specular;
}

void compose_pixel(uvec2 pixel, uint index)
{
    vec3 radiance = load_emitted(index);
    PrimarySurface primary = load_primary_surface(index);
    if (primary.depth >= 0.0)
        radiance += unpack_light3(load_throughput(index)) * reflected_light(pixel, index, primary.surface);
    // One broken path must not blacken a pixel for ever.
    if (is_broken(radiance)) {
        count_broken_pixel();
        radiance = vec3(0.0);
    }
    if ((frame.flags & FRAME_LAYERED) != 0u)
        store_layers(index, pack_light3(radiance));
    else
        store_picture(index, radiance);
}

VKPT_RUN_OVER_PIXELS(compose_pixel)
