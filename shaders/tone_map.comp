#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// From radiance to what the screen shows, at the window's size: under water it sways, bright things shine over,
// exposure and tone curve, the engine's blend, gamma, and 8 bits by blue noise. Debug views take the image's place. For
// HDR screens also what they show beyond that.
#include "lib/frame.glsl"
#include "lib/exposure.glsl"
#include "bloom/bloom.glsl"
#include "lib/debug_views.glsl"
#include "lib/present_packing.glsl"
#include "lib/random.glsl"
#include "lib/sharpen.glsl"
#include "lib/surfaces.glsl"

// A shoulder and a toe around a straight middle, rational in x: a (x (x + toe)) / (x (x shoulder + slope) + lift),
// scaled so that `white` maps to 1.
vec3 filmic_curve(vec3 x)
{
    const float toe = 0.025, shoulder = 0.96, slope = 0.60, lift = 0.12, white = 11.0;
    const float at_white = white * (white + toe) / (white * (white * shoulder + slope) + lift);
    return quick_clamp(x * (x + toe) / (x * (x * shoulder + slope) + lift) * (1.0 / at_white), 0.0, 1.0);
}

// The same for a screen with headroom: what the shoulder takes from bright light is given back up to `headroom`. Dark
// light gains x^2 / 4 whatever the headroom is: 6 % at 0.18.
vec3 filmic_curve_of_hdr(vec3 x, float headroom)
{
    float above = headroom - 1.0;
    return filmic_curve(x) + above * (x * x) / (x * x + 4.0 * above);
}

vec3 encode_srgb(vec3 linear)
{
    return mix(1.055 * pow(quick_max(linear, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055, linear * 12.92,
        lessThan(linear, vec3(0.0031308)));
}

// The image's radiance at a place from (0, 0) to (1, 1): as it is where pixels match, else between four of them.
vec3 sample_radiance(vec2 place)
{
    uvec2 size = frame.resolved_size;
    vec2 at = clamp(place * vec2(size) - 0.5, vec2(0.0), vec2(size - 1u)), part = fract(at);
    if (all(lessThan(abs(fract(at + 0.5) - 0.5), vec2(1e-3)))) {
        uvec2 pixel = uvec2(whole_to_int(floor(at + 0.5)));
        return load_accumulated(pixel.y * size.x + pixel.x).rgb;
    }
    uvec2 corner = uvec2(whole_to_int(floor(at)));
    uint first = corner.y * size.x + corner.x;
    uint right = at.x < float(size.x - 1u) ? 1u : 0u, down = at.y < float(size.y - 1u) ? size.x : 0u;
    return mix(mix(load_accumulated(first), load_accumulated(first + right), part.x),
        mix(load_accumulated(first + down), load_accumulated(first + down + right), part.x), part.y)
        .rgb;
}

// The same, sharpened against what the window's pixels around it show.
vec3 sample_sharpened(vec2 place)
{
    float exposure = ExposureBuffer(frame.exposure).v.exposure;
    vec3 shades[5];
    const vec2 ways[5] = vec2[](vec2(0.0), vec2(-1.0, 0.0), vec2(1.0, 0.0), vec2(0.0, -1.0), vec2(0.0, 1.0));
    UNROLLED_FOR (int i = 0; i < 5; i++)
        shades[i] = to_shades(sample_radiance(place + ways[i] / vec2(frame.output_size)) * exposure);
    return from_shades(sharpen(shades[0], shades[1], shades[2], shades[3], shades[4], frame.cvars.flt_sharpen))
        / exposure;
}

// Where the eye sees `place` from under water: displaced along each axis by a wave that runs along the other, and drawn
// in by as much as the waves are high, so that nothing beyond the edge is asked for.
vec2 sway(vec2 place)
{
    float height = 0.008 * frame.cvars.pt_water_warp;
    vec2 phase = place.yx * vec2(14.0, 11.0) + frame.time * vec2(1.9, 1.6);
    return mix(vec2(0.5), place, 1.0 - 2.0 * height) + height * sin(phase);
}

// Radiance at a pixel of the window, exposed: 1 is white.
vec3 exposed_radiance(uvec2 pixel)
{
    vec2 place = (vec2(pixel) + 0.5) / vec2(frame.output_size);
    if ((frame.flags & FRAME_UNDERWATER) != 0u && frame.cvars.pt_water_warp > 0.0)
        place = sway(place);
    vec3 radiance = frame.cvars.flt_sharpen > 0.0 ? sample_sharpened(place) : sample_radiance(place);
    if ((frame.flags & FRAME_BLOOM) != 0u)
        radiance = mix(
            radiance, sample_bloom_level(frame.screen.bloom.address, frame.bloom_size, place), frame.cvars.pt_bloom);
    return radiance * (ExposureBuffer(frame.exposure).v.exposure * frame.overbright);
}

// As the player wants to see what the tone curve has made; `brightest` is the most that is shown.
vec3 encode_display(vec3 display, vec3 brightest)
{
    vec3 colour = mix(quick_min(encode_srgb(display) * frame.intensity, brightest), frame.blend.rgb, frame.blend.a);
    // The players' gamma was made for unlit darkness: 1.2, its default, changes nothing here.
    float gamma = 1.2 / max(frame.gamma, 0.1);
    if (abs(gamma - 1.0) > 1e-3)
        colour = pow(colour, vec3(gamma));
    return colour;
}

vec3 shown_colour(vec3 exposed, uvec2 pixel)
{
    vec3 display = frame.cvars.pt_tone_map == TONE_MAP_FILMIC ? filmic_curve(exposed) : quick_clamp(exposed, 0.0, 1.0);
    float dither = blue_dimension(BlueNoiseBuffer(frame.blue_noise), pixel, frame.frame_index,
                       blue_period_key(frame.frame_index, 0u), 0u)
        - 0.5;
    return encode_display(display, vec3(1.0)) + dither / 255.0;
}

// What an HDR screen shows of it. 10 bits need no dither.
vec3 shown_colour_of_hdr(vec3 exposed)
{
    vec3 display = frame.cvars.pt_tone_map == TONE_MAP_FILMIC ? filmic_curve_of_hdr(exposed, frame.headroom)
                                                              : quick_clamp(exposed, 0.0, frame.headroom);
    return encode_display(display, encode_srgb(vec3(frame.headroom)));
}

// Of the finished image; `alpha`: see FrameUniforms::highlights.
void store_shown(uint at, vec3 shown, float alpha)
{
    store_element(frame.output_words, at, pack_unorm4(vec4(shown, alpha)));
}

void show_pixel(uvec2 pixel, uint index)
{
    // Views without a world stand before what 2D has drawn.
    if ((frame.flags & FRAME_NO_WORLD) != 0u) {
        uvec2 rendered = min(pixel * frame.size / frame.output_size, frame.size - 1u);
        if (load_position(pixel_index(rendered)).w == DEPTH_NOTHING)
            return;
    }
    uvec2 place = frame.output_origin + pixel;
    uint at = place.y * frame.output_across + place.x;
    if (frame.cvars.pt_debug_view != DEBUG_VIEW_OFF) {
        uvec2 rendered = min(pixel * frame.size / frame.output_size, frame.size - 1u);
        vec3 colour = debug_colour(
            frame.cvars.pt_debug_view, rendered, pixel_index(rendered), ExposureBuffer(frame.exposure).v.exposure);
        store_shown(at, encode_srgb(clamp(colour, 0.0, 1.0)), 1.0);
        return;
    }
    vec3 exposed = exposed_radiance(pixel), shown = shown_colour(exposed, pixel);
    store_shown(at, shown, frame.headroom > 1.0 ? 0.0 : 1.0);
    if (frame.headroom > 1.0) {
        vec3 stored = unpack_unorm4(pack_unorm4(vec4(shown, 0.0))).rgb;
        store_element(frame.highlights, at, pack_highlight(shown_colour_of_hdr(exposed) - stored));
    }
}

VKPT_RUN_OVER(frame.output_size, show_pixel)
