#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The first level of the spatial filter: 3 x 3 pixels. Where too few frames tell how much the light varies, these pixels do.
#include "lib/frame.glsl"
#include "lib/denoise_taps.glsl"

layout(push_constant, scalar) uniform PushBlock { FilterPush push; };

float filtered_deviation(Sums sums, float deviation)
{
    const float taps = 9.0;
    float scale = 1.0 / sums.weight, mean = luminance(sums.light) * scale;
    float measured = max(sums.square * scale - mean * mean, 0.0) / taps;
    return sqrt(is_known(deviation) ? sums.variance * scale * scale : measured);
}

void filter_pixel(uvec2 pixel, uint index)
{
    uvec2 guide = load_guide(index);
    uvec4 bits = load_element(push.source, index, uvec4(0u));
    if (guide_depth(guide) <= 0.0) {
        store_element(push.target.address, index, bits);
        return;
    }
    FilteredLight light = unpack_filtered(bits);
    Pixel centre = make_pixel(index, guide, light);
    float fall = specular_fall(1.0, unpack_moments(load_moments(index)).specular_reach);

    // Taps beyond the edge do not count; they read the pixel at the edge.
    uvec2 last = frame.size - 1u, before = pixel - min(pixel, uvec2(1u)), after = min(pixel + 1u, last);
    uint columns[3] = uint[](before.x, pixel.x, after.x);
    uint rows[3] = uint[](before.y * frame.size.x, index - pixel.x, after.y * frame.size.x);
    float across[3] = float[](pixel.x > 0u ? 0.25 : 0.0, 0.5, pixel.x < last.x ? 0.25 : 0.0);
    float down[3] = float[](pixel.y > 0u ? 0.25 : 0.0, 0.5, pixel.y < last.y ? 0.25 : 0.0);

    Sums diffuse = Sums(vec3(0.0), 0.0, 0.0, 0.0), specular = diffuse;
    add_tap(diffuse, light.diffuse, centre.diffuse_luminance, light.diffuse_deviation, 0.25);
    add_tap(specular, light.specular, centre.specular_luminance, light.specular_deviation, 0.25);
    [[unroll]] for (int y = 0; y < 3; y++)
        [[unroll]] for (int x = 0; x < 3; x++)
            if (x != 1 || y != 1)
                add_neighbour(diffuse, specular, centre, push.source, rows[y] + columns[x], vec2(x - 1, y - 1), across[x] * down[y],
                    x != 1 && y != 1 ? fall * fall : fall);
    FilteredLight result;
    result.diffuse = diffuse.light / diffuse.weight;
    result.specular = specular.light / specular.weight;
    result.diffuse_deviation = filtered_deviation(diffuse, light.diffuse_deviation);
    result.specular_deviation = filtered_deviation(specular, light.specular_deviation);
    store_element(push.target.address, index, pack_filtered(result));
}

VKPT_RUN_OVER_PIXELS(filter_pixel)
