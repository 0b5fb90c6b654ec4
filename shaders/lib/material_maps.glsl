// SPDX-License-Identifier: GPL-2.0-or-later
// How a normal map tilts the shading normal and, where it is seen from afar, makes the surface rougher (Toksvig 2005,
// Mipmapping Normal Maps). Texels: ref_vkpt/scene/normal_maps.hpp.
#ifndef VKPT_LIB_MATERIAL_MAPS
#define VKPT_LIB_MATERIAL_MAPS

#include "../shared/scene.h"
#include "bsdf.glsl"

struct NormalMapTexel {
    vec3 direction; // x along u, y along v, z out of the surface; not of length 1
    float variance; // of the slope along each axis, within the texel
    float metalness;
};

uint normal_map(Material material) { return material.maps & 0xffffu; }

float bump_scale(Material material)
{
    return float(material.map_scales & ((1u << MATERIAL_BUMP_BITS) - 1u)) / MATERIAL_BUMP_ONE;
}

// The mip of the normal map for `mip` of the texture.
float normal_map_mip(Material material, float mip)
{
    return mip + float(int(material.map_scales << MATERIAL_MIP_BITS) >> (32u - MATERIAL_MIP_BITS)) / MATERIAL_MIP_ONE;
}

uint emissive_map(Material material) { return material.maps >> 16u; }

float emissive_map_mip(Material material, float mip)
{
    return mip + float(int(material.map_scales) >> (32u - MATERIAL_MIP_BITS)) / MATERIAL_MIP_ONE;
}

NormalMapTexel unpack_normal_texel(vec4 texel, float scale)
{
    vec2 tilt = (texel.xy * 255.0 - 128.0) / 127.0;
    float height = sqrt(quick_max(1.0 - dot(tilt, tilt), 1e-4));
    NormalMapTexel result;
    // As Q2RTX scales it: between the surface's own normal and the map's.
    result.direction = vec3(tilt * scale, quick_max(1.0 + (height - 1.0) * scale, 0.02));
    float spread = texel.z * scale;
    result.variance = spread * spread;
    result.metalness = texel.w;
    return result;
}

// Along the texture's u, across `normal`; w: 1 where the texture's v runs along cross(normal, xyz), else -1. Zero where
// the texture does not change along u.
vec4 find_tangent(Triangle triangle, vec3 normal)
{
    vec3 e1 = triangle.positions[1] - triangle.positions[0], e2 = triangle.positions[2] - triangle.positions[0];
    vec2 t1 = triangle.uvs[1] - triangle.uvs[0], t2 = triangle.uvs[2] - triangle.uvs[0];
    float side = t1.x * t2.y - t2.x * t1.y < 0.0 ? -1.0 : 1.0;
    vec3 along = (e1 * t2.y - e2 * t1.y) * side;
    along -= normal * dot(along, normal);
    return vec4(along * inversesqrt(quick_max(dot(along, along), 1e-20)), side);
}

// Normals that face away from the viewer would show a side that cannot be seen: they are bent back as far as it takes.
vec3 bend_to_viewer(vec3 normal, vec3 view)
{
    const float min_cosine = 0.01;
    float cosine = dot(normal, view);
    return cosine >= min_cosine ? normal : normalize(normal + view * (min_cosine - cosine));
}

// GGX: alpha^2 grows by twice the variance of the slope along each axis, as that of facets of alpha is alpha^2 / 2.
float widen_roughness(float roughness, float variance)
{
    float alpha = roughness * roughness;
    return variance > 0.0 ? sqrt(sqrt(quick_min(alpha * alpha + 2.0 * variance, 1.0))) : roughness;
}

// `tangent`: see find_tangent; `facing`: 1 where the triangle is met from its front, else -1. s.normal is on the
// viewer's side.
void apply_normal_map(NormalMapTexel texel, vec4 tangent, uint flags, float facing, inout Surface s)
{
    vec3 normal = s.normal * facing;
    vec3 tilted = tangent.xyz * texel.direction.x + cross(normal, tangent.xyz) * (tangent.w * texel.direction.y)
        + normal * texel.direction.z;
    s.normal = bend_to_viewer(normalize(tilted) * facing, s.view);
    s.roughness = widen_roughness(s.roughness, texel.variance);
    if ((flags & MATERIAL_METALNESS_IN_ALPHA) != 0u)
        s.metallic *= texel.metalness;
}

#endif
