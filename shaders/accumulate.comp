#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Puts the image's radiance together, the last level of the spatial filter included, and averages it with the frames
// before while nothing moves.
#define VKPT_DEVIATIONS_ARE_KNOWN
#include "lib/frame.glsl"
#include "denoise/denoise_atrous.glsl"
#include "lib/dlights.glsl"
#include "lib/image.glsl"
#include "lib/scattered_light.glsl"

// Diffuse without albedo.
ReflectedLight reflected_light(uvec2 pixel, uint index, Surface surface)
{
    if ((frame.flags & FRAME_DENOISED) == 0u)
        return fetch_reflected_light(index);
    FilteredLight light;
    if (frame.cvars.flt_denoiser == DENOISER_TEMPORAL)
        light = unpack_filtered(load_filtered(index));
    else
        light = filter_atrous(pixel, index, load_features(index), load_element(push.source, index, uvec4(0u)));
    return ReflectedLight(light.diffuse, specular_tint(surface) * light.specular);
}

// Darkness casts no shadow, and is as it is: what takes light away needs no rays and no filter.
vec3 taken_light(vec3 position)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < frame.dark_light_count; i++) {
        Dlight dark = DlightBuffer(frame.dark_lights).v[i];
        sum += dark.colour * quick_max(dark.intensity - distance(position, dark.origin), 0.0);
    }
    return sum;
}

// What the surface shows of it, as the player wants to see it.
vec3 shown_light(ReflectedLight light, Surface surface)
{
    if ((frame.flags & FRAME_FULLBRIGHT) != 0u)
        return surface.albedo;
    if ((frame.flags & FRAME_GREY_LIGHT) != 0u)
        light = ReflectedLight(vec3(luminance(light.diffuse)), vec3(luminance(light.specular)));
    // Samples may be negative where the cache is corrected (pt_indirect both): their mean counts.
    if (frame.dark_light_count > 0u)
        light.diffuse = max(light.diffuse - taken_light(surface.position), vec3(0.0));
    light.diffuse += frame.cvars.pt_min_light;
    return (frame.flags & FRAME_LIGHT_ALONE) != 0u ? light.diffuse : surface.albedo * light.diffuse + light.specular;
}

// How wrong the light cache is there, which is all that indirect_light has stored (FRAME_CACHE_BIAS).
vec3 cache_bias(uint index, PrimarySurface primary)
{
    ReflectedLight bias = fetch_reflected_light(index);
    return primary.depth < 0.0
        ? vec3(0.0)
        : unpack_light3(load_throughput(index)) * (primary.surface.albedo * bias.diffuse + bias.specular);
}

vec3 compose_radiance(uvec2 pixel, uint index, PrimarySurface primary)
{
    vec3 radiance = unpack_floats3(load_emitted(index));
    if (primary.depth >= 0.0)
        radiance += unpack_light3(load_throughput(index))
            * shown_light(reflected_light(pixel, index, primary.surface), primary.surface);
    if ((frame.flags & FRAME_GOD_RAYS) != 0u)
        radiance += spread_scattered(pixel, primary.depth);
    return radiance;
}

void compose_pixel(uvec2 pixel, uint index)
{
    PrimarySurface primary = load_primary_surface(index);
    vec3 radiance
        = (frame.flags & FRAME_CACHE_BIAS) != 0u ? cache_bias(index, primary) : compose_radiance(pixel, index, primary);
    // One path that is not finite must not blacken a pixel for ever.
    if (is_nonfinite(radiance)) {
        count_nonfinite_pixel();
        radiance = vec3(0.0);
    }
    uint marks = load_emitted(index).y & is_supersampled;
    if ((frame.flags & FRAME_LAYERED) != 0u)
        store_layers(index, pack_light3(radiance) | uvec2(0u, marks));
    else
        store_image(index, radiance, marks);
}

VKPT_RUN_OVER_PIXELS(compose_pixel)
