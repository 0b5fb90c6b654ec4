// SPDX-License-Identifier: GPL-2.0-or-later
// Triangles whose texture has holes: what a ray meets there is decided by the texture.
#ifndef VKPT_LIB_ALPHA_TEST
#define VKPT_LIB_ALPHA_TEST

#include "frame.glsl"
#include "device/wide_loads.glsl"

vec2 interpolate_uv(Triangle triangle, vec2 barycentrics)
{
    return triangle.uvs[0] * (1.0 - barycentrics.x - barycentrics.y) + triangle.uvs[1] * barycentrics.x
        + triangle.uvs[2] * barycentrics.y;
}

// Whether the texture of triangle `id` has a hole at this place. The largest mip level counts, whatever the distance.
bool is_cut_out(uint id, vec2 barycentrics)
{
    Triangle triangle = fetch_Triangle(frame.scene.triangles, id);
    Material material = fetch_Material(frame.scene.materials, triangle.material);
    if ((material.flags & MATERIAL_ALPHA_TEST) == 0u)
        return false;
    vec2 uv = interpolate_uv(triangle, barycentrics) + material.uv_scroll;
    return textureLod(VKPT_TEXTURE(material.texture, SAMPLER_REPEAT), uv, 0.0).a < 0.5;
}

#endif
