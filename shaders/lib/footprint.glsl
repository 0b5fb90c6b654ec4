// SPDX-License-Identifier: GPL-2.0-or-later
// How a texture is read over the footprint of a ray's cone: where the cone meets the surface it cuts out an ellipse,
// which grazing rays draw out (Akenine-Moeller et al., Ray Tracing Gems, chapter 20; Ray Tracing Gems II, chapter 10).
// One smooth texel as large as its longer axis would blur across the shorter one: so the longer one has several taps.
#ifndef VKPT_LIB_FOOTPRINT
#define VKPT_LIB_FOOTPRINT

#include "device/quick_floats.glsl"
#include "trace.glsl"

struct Footprint {
    vec2 axis; // the longer one, in uv
    float taps; // along it
    float mip; // whose texel is as large as what one tap stands for
};

// Grazing cones end here, or one pixel of the horizon would take in a whole floor.
const float min_footprint_cosine = 0.1;

// The mip whose texel is as large as the footprint's longer axis.
float choose_mip(Triangle triangle, vec2 size, float cone_width, float cosine)
{
    vec3 e1 = triangle.positions[1] - triangle.positions[0], e2 = triangle.positions[2] - triangle.positions[0];
    vec2 t1 = (triangle.uvs[1] - triangle.uvs[0]) * size, t2 = (triangle.uvs[2] - triangle.uvs[0]) * size;
    float texels = abs(t1.x * t2.y - t1.y * t2.x), area = length(cross(e1, e2));
    float footprint = cone_width / quick_max(abs(cosine), min_footprint_cosine);
    return 0.5 * log2(quick_max(texels / quick_max(area, 1e-12), 1e-12)) + log2(quick_max(footprint, 1e-6));
}

// `size`: of the texture in texels; `normal` and `direction`: the surface's and the ray's; at most `max_taps`.
Footprint find_footprint(Triangle triangle, vec2 size, float cone_width, vec3 normal, vec3 direction, float max_taps)
{
    vec3 e1 = triangle.positions[1] - triangle.positions[0], e2 = triangle.positions[2] - triangle.positions[0];
    vec2 t1 = triangle.uvs[1] - triangle.uvs[0], t2 = triangle.uvs[2] - triangle.uvs[0];
    // On the surface, along the ray and across it: the ellipse's axes. Seen from straight above, any will do.
    float cosine = dot(normal, direction);
    vec3 across = cross(normal, direction);
    float sine2 = dot(across, across);
    across = sine2 > 1e-6 ? across * inversesqrt(sine2) : normalize(e1);
    vec3 along = cross(across, normal) * (cone_width / quick_max(abs(cosine), min_footprint_cosine));
    across *= cone_width;
    // What a step on the surface is in uv.
    vec3 scaled = cross(e1, e2), to_first = cross(e2, scaled), to_second = cross(scaled, e1);
    float scale = 1.0 / quick_max(dot(scaled, scaled), 1e-12);
    vec2 first = (t1 * dot(along, to_first) + t2 * dot(along, to_second)) * scale;
    vec2 second = (t1 * dot(across, to_first) + t2 * dot(across, to_second)) * scale;
    float first2 = dot(first * size, first * size), second2 = dot(second * size, second * size);
    vec2 axis = first2 > second2 ? first : second;
    float longer = sqrt(quick_max(first2, second2)), shorter = sqrt(quick_min(first2, second2));
    float taps = quick_clamp(floor(longer / quick_max(shorter, 1e-6) + 0.5), 1.0, max_taps);
    return Footprint(axis, taps, log2(quick_max(longer / taps, 1e-6)));
}

#endif
