// SPDX-License-Identifier: GPL-2.0-or-later
// Entries of the scene's tables, read by 64-bit loads. The CPU driver makes gathers of eight lanes out of every load, and they
// cost the same for 32 and 64 bits; on processors that are slowed down against data sampling that is about 10 ns each, and
// most of the time of the passes that trace or light. GPUs merge loads of either width.
#ifndef VKPT_LIB_WIDE_LOADS
#define VKPT_LIB_WIDE_LOADS

#include "../shared/functions.h"
#include "../shared/scene.h"

#ifdef __cplusplus
#define VKPT_FETCH(type, table, index) (table).v[index]
#else
#define VKPT_FETCH(type, table, index) fetch_##type(uint64_t(table), index)

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer WideWords { uint64_t v[]; };

uvec2 load_pair(WideWords words, uint index) { return unpack32(words.v[index]); }
vec2 load_float_pair(WideWords words, uint index) { return uintBitsToFloat(unpack32(words.v[index])); }

// `table`: an address, a multiple of 8.
Emitter fetch_Emitter(uint64_t table, uint index)
{
    WideWords words = WideWords(table + uint64_t(index) * 64ul);
    vec2 a = load_float_pair(words, 0u), c = load_float_pair(words, 2u), e = load_float_pair(words, 4u);
    uvec2 b = load_pair(words, 1u), d = load_pair(words, 3u);
    vec2 f = load_float_pair(words, 5u), g = load_float_pair(words, 6u), h = load_float_pair(words, 7u);
    return Emitter(vec3(a, uintBitsToFloat(b.x)), b.y, vec3(c, uintBitsToFloat(d.x)), d.y, vec3(e, f.x), f.y, vec3(g, h.x), h.y);
}

EmitterOutline fetch_EmitterOutline(uint64_t table, uint index)
{
    WideWords words = WideWords(table + uint64_t(index * 32u));
    vec2 a = load_float_pair(words, 0u), b = load_float_pair(words, 1u);
    uvec2 c = load_pair(words, 2u), d = load_pair(words, 3u);
    return EmitterOutline(vec3(a, b.x), b.y, uint[4](c.x, c.y, d.x, d.y));
}

LightList fetch_LightList(uint64_t table, uint index)
{
    WideWords words = WideWords(table + uint64_t(index) * 16ul);
    uvec2 a = load_pair(words, 0u), b = load_pair(words, 1u);
    return LightList(a.x, a.y, b.x, b.y);
}

BspTreeNode fetch_BspTreeNode(uint64_t table, uint index)
{
    WideWords words = WideWords(table + uint64_t(index) * 24ul);
    vec2 a = load_float_pair(words, 0u), b = load_float_pair(words, 1u);
    ivec2 c = ivec2(load_pair(words, 2u));
    return BspTreeNode(vec3(a, b.x), b.y, c.x, c.y);
}

Triangle fetch_Triangle(uint64_t table, uint index)
{
    WideWords words = WideWords(table + uint64_t(index) * 88ul);
    vec2 a = load_float_pair(words, 0u), b = load_float_pair(words, 1u), c = load_float_pair(words, 2u),
         d = load_float_pair(words, 3u), e = load_float_pair(words, 4u), f = load_float_pair(words, 5u),
         g = load_float_pair(words, 6u);
    uvec2 h = load_pair(words, 7u), i = load_pair(words, 8u), j = load_pair(words, 9u), k = load_pair(words, 10u);
    Triangle result;
    result.positions[0] = vec3(a, b.x);
    result.positions[1] = vec3(b.y, c);
    result.positions[2] = vec3(d, e.x);
    result.uvs[0] = vec2(e.y, f.x);
    result.uvs[1] = vec2(f.y, g.x);
    result.uvs[2] = vec2(g.y, uintBitsToFloat(h.x));
    result.normals[0] = h.y;
    result.normals[1] = i.x;
    result.normals[2] = i.y;
    result.material = j.x;
    result.emitter = int(j.y);
    result.cluster = int(k.x);
    result.padding = k.y;
    return result;
}

Material fetch_Material(uint64_t table, uint index)
{
    WideWords words = WideWords(table + uint64_t(index) * 56ul);
    vec2 a = load_float_pair(words, 0u), b = load_float_pair(words, 1u), c = load_float_pair(words, 2u),
         d = load_float_pair(words, 3u);
    uvec2 e = load_pair(words, 4u), f = load_pair(words, 5u), g = load_pair(words, 6u);
    Material result;
    result.tint = vec3(a, b.x);
    result.opacity = b.y;
    result.emission = vec3(c, d.x);
    result.roughness = d.y;
    result.metallic = uintBitsToFloat(e.x);
    result.texture = e.y;
    result.flags = f.x;
    result.uv_scroll = uintBitsToFloat(uvec2(f.y, g.x));
    result.lightstyle = g.y;
    return result;
}

#endif

#endif
