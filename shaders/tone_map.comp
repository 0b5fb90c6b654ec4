#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// From radiance to what the screen shows, at the window's size; debug views take the picture's place.
#include "lib/frame.glsl"
#include "lib/debug_views.glsl"

layout(set = 0, binding = 1, rgba8) uniform writeonly image2D picture;
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ExposureBuffer { ExposureState v; };

layout(local_size_x = PIXEL_GROUP_SIZE) in;

// A shoulder and a toe around a straight middle, rational in x: a (x (x + toe)) / (x (x shoulder + slope) + lift), scaled so
// that `white` maps to 1.
vec3 filmic_curve(vec3 x)
{
    const float toe = 0.025, shoulder = 0.96, slope = 0.60, lift = 0.12, white = 11.0;
    const float at_white = white * (white + toe) / (white * (white * shoulder + slope) + lift);
    return clamp(x * (x + toe) / (x * (x * shoulder + slope) + lift) / at_white, 0.0, 1.0);
}

vec3 encode_srgb(vec3 linear)
{
    return mix(1.055 * pow(max(linear, 0.0031308), vec3(1.0 / 2.4)) - 0.055, linear * 12.92, lessThan(linear, vec3(0.0031308)));
}

// `pixel` of the window, `source` and `index` of the rendered pixel there.
vec3 shown_colour(uvec2 pixel, uvec2 source, uint index)
{
    if (frame.cvars.pt_debug_view != DEBUG_VIEW_OFF)
        return encode_srgb(clamp(debug_colour(frame.cvars.pt_debug_view, source, index), 0.0, 1.0));
    vec3 exposed = load_accumulated(index) * ExposureBuffer(frame.exposure).v.exposure;
    vec3 display = frame.cvars.pt_tone_map == TONE_MAP_FILMIC ? filmic_curve(exposed) : clamp(exposed, 0.0, 1.0);
    vec3 colour = mix(encode_srgb(display), frame.blend.rgb, frame.blend.a);
    // The players' gamma was made for unlit darkness: 1.2, its default, changes nothing here.
    colour = pow(colour, vec3(1.2 / max(frame.gamma, 0.1)));
    float dither = blue_dimension(BlueNoiseBuffer(frame.blue_noise), pixel, frame.frame_index, 0u, 0u) - 0.5;
    return colour + dither / 255.0;
}

void main()
{
    uint tiles_across = (frame.output_size.x + 7u) / 8u, tile_count = tiles_across * ((frame.output_size.y + 7u) / 8u);
    for (uint i = 0u; i < PIXEL_TILES_PER_GROUP; i++) {
        uint tile = gl_WorkGroupID.x * PIXEL_TILES_PER_GROUP + i;
        uvec2 pixel = uvec2(tile % tiles_across, tile / tiles_across) * 8u + pixel_in_tile(gl_LocalInvocationIndex);
        if (tile >= tile_count || any(greaterThanEqual(pixel, frame.output_size)))
            continue;
        uvec2 source = min(pixel * frame.size / frame.output_size, frame.size - 1u);
        uint index = source.y * frame.size.x + source.x;
        // Views without a world stand before what 2D has drawn.
        if ((frame.flags & FRAME_NO_WORLD) != 0u && load_position(index).w == DEPTH_NOTHING)
            continue;
        imageStore(picture, ivec2(frame.output_origin + pixel), vec4(shown_colour(pixel, source, index), 1.0));
    }
}
