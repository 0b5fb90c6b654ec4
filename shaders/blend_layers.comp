#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Puts the layers together that pixels share out (lib/interleaved_layers.glsl): the mean of what the three classes of
// pixels show here, each its own layer, or that of the neighbours that follow it.
#include "lib/frame.glsl"
#include "lib/interleaved_layers.glsl"
#include "lib/image.glsl"

// What another class shows: neighbours of that class across and up or down, as far as they show layers, too.
vec3 other_layer(vec3 own, uvec2 pixel, uint index, int way)
{
    uvec2 across = uvec2(ivec2(pixel) + ivec2(way, 0)), along = uvec2(ivec2(pixel) - ivec2(0, way));
    uint a = is_on_screen(across) ? pixel_index(across) : index, b = is_on_screen(along) ? pixel_index(along) : index;
    bool use_a = differing_layers(a) != 0u && a != index, use_b = differing_layers(b) != 0u && b != index;
    vec3 light_a = unpack_light3(load_layers(a)), light_b = unpack_light3(load_layers(b));
    return use_a ? (use_b ? 0.5 * (light_a + light_b) : light_a) : (use_b ? light_b : own);
}

void blend_pixel(uvec2 pixel, uint index)
{
    uvec2 layer = load_layers(index);
    vec3 radiance = unpack_light3(layer);
    uint differs = differing_layers(index);
    if (differs != 0u) {
        vec3 next = (differs & next_differs) != 0u ? other_layer(radiance, pixel, index, 1) : radiance;
        vec3 last = (differs & last_differs) != 0u ? other_layer(radiance, pixel, index, -1) : radiance;
        radiance = (radiance + next + last) * (1.0 / 3.0);
    }
    store_image(index, radiance, layer.y & is_supersampled);
}

VKPT_RUN_OVER_PIXELS(blend_pixel)
