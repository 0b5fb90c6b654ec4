// SPDX-License-Identifier: GPL-2.0-or-later
// Entries of the scene's tables, by loads as wide as can be: as texels where frame.glsl has defined VKPT_SCENE_TEXELS
// (see texels.glsl), else of 128 bits on GPUs and of 64 on the CPU driver. The CPU driver makes gathers of eight lanes
// out of every load by address, and they cost the same for 32 and 64 bits; on processors that are slowed down against
// data sampling that is about 10 ns each, and most of the time of the passes that trace or light.
#ifndef VKPT_LIB_WIDE_LOADS
#define VKPT_LIB_WIDE_LOADS

#include "../../shared/functions.h"
#include "../../shared/scene.h"

#ifdef __cplusplus
#define VKPT_FETCH(type, table, index) (table).v[index]
#else
#define VKPT_FETCH(type, table, index) fetch_##type(uint64_t(table), index)

#include "texels.glsl"

#ifdef VKPT_SCENE_TEXELS
VKPT_TEXELS(triangle_texels, TEXELS_TRIANGLES)
VKPT_TEXELS(material_texels, TEXELS_MATERIALS)
VKPT_TEXELS(emitter_texels, TEXELS_EMITTERS)
VKPT_TEXELS(packed_light_texels, TEXELS_PACKED_LIGHTS)
VKPT_TEXELS(static_light_texels, TEXELS_STATIC_LIGHTS)
#define VKPT_ENTRY_TEXEL(name, table, bytes, index, i) VKPT_TEXEL(name, 0u, table, bytes, index, i)
#else
#define VKPT_ENTRY_TEXEL(name, table, bytes, index, i) VKPT_LOAD_TEXEL(table, bytes, index, i)
#endif

// `table`: an address, a multiple of 8.
LightList fetch_LightList(uint64_t table, uint index)
{
    uvec4 words = load_texel(table + uint64_t(index * 16u), 0u);
    return LightList(words.x, words.y, words.z, words.w);
}

BspTreeNode fetch_BspTreeNode(uint64_t table, uint index)
{
    uint64_t address = table + uint64_t(index * 24u);
    uvec4 a = load_texel(address, 0u);
    ivec2 b = ivec2(unpack32(TexelWords(address).v[2]));
    return BspTreeNode(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), b.x, b.y);
}

LightTreeNode fetch_LightTreeNode(uint64_t table, uint index)
{
    uint64_t address = table + uint64_t(index * 48u);
    vec4 a = uintBitsToFloat(load_texel(address, 0u)), b = uintBitsToFloat(load_texel(address, 1u));
    uvec4 c = load_texel(address, 2u);
    return LightTreeNode(a.xyz, a.w, b.xyz, b.w, uintBitsToFloat(c.x), c.y, c.z, c.w);
}

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer LightIndexWords { uint v[]; };

// Of the static lights.
uint fetch_LightIndex(uint64_t table, uint index)
{
#ifdef VKPT_SCENE_TEXELS
    if (tables_are_texels)
        return texelFetch(static_light_texels, int(index)).x;
#endif
    return LightIndexWords(table).v[index];
}

Emitter fetch_Emitter(uint64_t table, uint index)
{
    uvec4 a = VKPT_ENTRY_TEXEL(emitter_texels, table, 64u, index, 0u),
          b = VKPT_ENTRY_TEXEL(emitter_texels, table, 64u, index, 1u),
          c = VKPT_ENTRY_TEXEL(emitter_texels, table, 64u, index, 2u),
          d = VKPT_ENTRY_TEXEL(emitter_texels, table, 64u, index, 3u);
    return Emitter(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz),
        uintBitsToFloat(c.w), uintBitsToFloat(d.xyz), uintBitsToFloat(d.w));
}

PackedLight fetch_PackedLight(uint64_t table, uint index)
{
    uvec4 a = VKPT_ENTRY_TEXEL(packed_light_texels, table, 32u, index, 0u),
          b = VKPT_ENTRY_TEXEL(packed_light_texels, table, 32u, index, 1u);
    return PackedLight(uintBitsToFloat(a.xyz), a.w, uint[4](b.x, b.y, b.z, b.w));
}

Triangle fetch_Triangle(uint64_t table, uint index)
{
    vec4 a = uintBitsToFloat(VKPT_ENTRY_TEXEL(triangle_texels, table, 96u, index, 0u));
    vec4 b = uintBitsToFloat(VKPT_ENTRY_TEXEL(triangle_texels, table, 96u, index, 1u));
    vec4 c = uintBitsToFloat(VKPT_ENTRY_TEXEL(triangle_texels, table, 96u, index, 2u));
    uvec4 d = VKPT_ENTRY_TEXEL(triangle_texels, table, 96u, index, 3u),
          e = VKPT_ENTRY_TEXEL(triangle_texels, table, 96u, index, 4u);
    uvec4 f = VKPT_ENTRY_TEXEL(triangle_texels, table, 96u, index, 5u);
    Triangle result;
    result.positions[0] = a.xyz;
    result.positions[1] = vec3(a.w, b.xy);
    result.positions[2] = vec3(b.zw, c.x);
    result.uvs[0] = c.yz;
    result.uvs[1] = vec2(c.w, uintBitsToFloat(d.x));
    result.uvs[2] = uintBitsToFloat(d.yz);
    result.normals[0] = d.w;
    result.normals[1] = e.x;
    result.normals[2] = e.y;
    result.material = e.z;
    result.emitter = int(e.w);
    result.cluster = int(f.x);
    result.lightstyle = f.y;
    result.face = int(f.z);
    result.medium = f.w;
    return result;
}

Material fetch_Material(uint64_t table, uint index)
{
    uvec4 a = VKPT_ENTRY_TEXEL(material_texels, table, 64u, index, 0u),
          b = VKPT_ENTRY_TEXEL(material_texels, table, 64u, index, 1u),
          c = VKPT_ENTRY_TEXEL(material_texels, table, 64u, index, 2u),
          d = VKPT_ENTRY_TEXEL(material_texels, table, 64u, index, 3u);
    Material result;
    result.tint = uintBitsToFloat(a.xyz);
    result.opacity = uintBitsToFloat(a.w);
    result.emission = uintBitsToFloat(b.xyz);
    result.roughness = uintBitsToFloat(b.w);
    result.metallic = uintBitsToFloat(c.x);
    result.texture = c.y;
    result.flags = c.z;
    result.uv_scroll = uintBitsToFloat(uvec2(c.w, d.x));
    result.texture_size = d.y;
    result.maps = d.z;
    result.map_scales = d.w;
    return result;
}

#endif

#endif
