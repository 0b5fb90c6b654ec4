// SPDX-License-Identifier: GPL-2.0-or-later
// The light cache, as bounce rays read it: what arrives at a cell of a face from the map's own lights.
// docs/light-cache.md.
#ifndef VKPT_LIB_LIGHT_CACHE
#define VKPT_LIB_LIGHT_CACHE

#include "frame.glsl"
#include "surfaces.glsl"

CacheFace load_cache_face(uint face)
{
    uint64_t address = frame.scene.cache.faces + uint64_t(face * 48u);
    uvec4 a = load_element(address, 0u, uvec4(0u)), b = load_element(address, 1u, uvec4(0u)),
          c = load_element(address, 2u, uvec4(0u));
    return CacheFace(uintBitsToFloat(a), uintBitsToFloat(b), c.x, c.y, uint[2](c.z, c.w));
}

// CacheValue, unpacked.
struct LightOfStyle {
    vec3 light;
    vec3 direction;
    float power;
    uint count;
    uint guide;
};

// CacheValue::direction
vec3 unpack_cached_direction(uint word)
{
    return vec3(ivec3(uvec3(word, word >> 10u, word >> 20u) & 1023u) - 512) / 511.0;
}

// `value`: below LightCacheView::value_count what rays read, from there on what updates work on.
LightOfStyle load_cache_value(uint value)
{
    uvec4 words = load_element(frame.scene.cache.values, value, uvec4(0u));
    LightOfStyle result;
    uvec3 light = uvec3(words.x, (words.x >> 21u) | (words.y << 11u), words.y >> 10u) << 10u;
    result.light = uintBitsToFloat(light & 0x7ffffc00u);
    result.direction = unpack_cached_direction(words.z);
    result.power = float(int((words.w >> CACHE_POWER_SHIFT) & 0xffu)) / 255.0;
    result.count = words.w & CACHE_COUNT_MASK;
    result.guide = words.w >> CACHE_GUIDE_SHIFT;
    return result;
}

// CacheLobe, unpacked.
struct LightLobe {
    vec3 light;
    vec3 direction;
};

LightLobe load_cache_lobe(uint lobe)
{
    uvec2 words = load_element(frame.scene.cache.lobes, lobe, uvec2(0u));
    return LightLobe(unpack_rgb9e5(words.x), unpack_cached_direction(words.y));
}

// Which of a value's lobes light from there belongs to: one of four sides, high above the face or low.
uint lobe_of_direction(CacheFace face, vec3 direction)
{
    const float min_flat2 = 0.64; // square of the direction's part along the face, from which on it is low
    vec2 flat_part = vec2(dot(face.across.xyz, direction), dot(face.down.xyz, direction));
    bool is_low = dot(flat_part, flat_part) > min_flat2 * dot(face.across.xyz, face.across.xyz);
    return (flat_part.x < 0.0 ? 1u : 0u) | (flat_part.y < 0.0 ? 2u : 0u) | (is_low ? 4u : 0u);
}

uvec2 cache_face_cells(CacheFace face)
{
    const uint mask = (1u << CACHE_SIZE_BITS) - 1u;
    return uvec2(face.size & mask, (face.size >> CACHE_SIZE_BITS) & mask);
}

uint cache_face_layers(CacheFace face) { return face.size >> (2u * CACHE_SIZE_BITS); }

uint cache_layer_style(CacheFace face, uint layer)
{
    return (face.styles[layer >> 1u] >> ((layer & 1u) * 16u)) & 0xffffu;
}

// Where a cell's layers begin.
uint find_cache_value(CacheFace face, vec3 position)
{
    vec2 place = vec2(dot(position, face.across.xyz) + face.across.w, dot(position, face.down.xyz) + face.down.w);
    uvec2 cells = cache_face_cells(face);
    uvec2 cell = min(floor_to_uint(max(place, vec2(0.0))), cells - 1u);
    return face.first_value + (cell.y * cells.x + cell.x) * cache_face_layers(face);
}

struct CachedLight {
    vec3 light; // irradiance / pi
    vec3 direction; // to it, on average
    float power; // schlick_power of its angle, on average
    uint guide; // number of the cell among the guides, 0: it is none
    bool known;
    uint face; // of the map, from 0
    uint first; // value of the cell
};

const CachedLight nothing_cached = CachedLight(vec3(0.0), vec3(0.0), 0.0, 0u, false, 0u, 0u);

// `face_number` as Triangle::face. Not known: the point has no cell, or one that too little is known of.
CachedLight read_light_cache(int face_number, vec3 position)
{
    CachedLight result = nothing_cached;
    if (face_number <= 0)
        return result;
    CacheFace face = load_cache_face(uint(face_number - 1));
    if (face.size == 0u)
        return result;
    uint first = find_cache_value(face, position);
    result.known = true;
    result.face = uint(face_number - 1);
    result.first = first;
    ROLLED_FOR (uint layer = 0u; layer < cache_face_layers(face); layer++) {
        float scale = lightstyle_scale(cache_layer_style(face, layer));
        LightOfStyle value = load_cache_value(first + layer);
        result.guide = layer == 0u ? value.guide : result.guide;
        if (scale > 0.0) {
            float weight = luminance(value.light) * scale;
            result.known = result.known && value.count >= CACHE_MIN_SAMPLES;
            result.light += value.light * scale;
            result.direction += value.direction * weight;
            result.power += value.power * weight;
        }
    }
    float total = quick_max(luminance(result.light), 1e-20);
    result.direction /= total;
    result.power /= total;
    return result;
}

// What a GGX coat without Fresnel's term reflects in the mean over all views; the rest would be reflected more than
// once, or leaves below the horizon. Fitted to sums over directions, within 0.01 for alpha from 0.1 to 1.
float mean_ggx_reflectance(float alpha)
{
    float root = sqrt(alpha);
    return 1.0 / (1.0 + 1.45 * alpha * root * sqrt(root)); // alpha^1.75
}

float direction_spread(vec3 mean) { return quick_clamp(1.0 - length(mean), 0.0, 1.0); }

// What the coat, or a metal, sends back of light from these directions, whose mean is known: as of a single light
// there, but rougher by as much as directions are spread. Half vectors are spread half as much as directions, whose
// variance along each axis is about one less the mean's length. It reflects as much as with its own roughness.
vec3 reflect_spread_light(Surface s, LightLobe lobe)
{
    float alpha = ggx_alpha(s.roughness),
          wide_alpha = sqrt(quick_min(alpha * alpha + 0.5 * direction_spread(lobe.direction), 1.0));
    Surface wide = s;
    wide.roughness = sqrt(wide_alpha);
    return lobe.light * evaluate_brdf(wide, normalize(lobe.direction + s.normal * 1e-6)).specular
        * (mean_ggx_reflectance(alpha) / mean_ggx_reflectance(wide_alpha));
}

// Radiance that the surface sends back of the light. Diffuse light exactly: Fresnel's term is linear in schlick_power.
// Of a coat, all light is one lobe, of a metal each of the cell's is.
vec3 reflect_cached_light(Surface s, CachedLight cached)
{
    bool is_metal = s.metallic >= 0.5;
    CacheFace face;
    uint lobes = 1u;
    if (is_metal) {
        face = load_cache_face(cached.face);
        lobes = cache_face_layers(face) * CACHE_LOBES;
    }
    float scale = 1.0;
    vec3 specular = vec3(0.0);
    ROLLED_FOR (uint i = 0u; i < lobes; i++) {
        LightLobe lobe = LightLobe(cached.light, cached.direction);
        if (is_metal) {
            if (i % CACHE_LOBES == 0u)
                scale = lightstyle_scale(cache_layer_style(face, i / CACHE_LOBES));
            lobe = load_cache_lobe(cached.first * CACHE_LOBES + i);
            lobe.light *= scale;
        }
        if (lobe.light != vec3(0.0))
            specular += reflect_spread_light(s, lobe);
    }
    float rise = coat_rise(s), nv = dot(s.normal, view_above_horizon(s));
    float diffuse = coupled_diffuse_base(s, nv) * (1.0 - dielectric_fresnel(s, rise * cached.power));
    return bsdf_pi * (s.albedo * diffuse * cached.light + specular);
}

// For pt_debug_view.
vec3 show_light_cache(HitSurface hit)
{
    CachedLight cached = read_light_cache(hit.face, hit.surface.position);
    if (!cached.known || hit.front == 0.0)
        return vec3(0.3, 0.0, 0.3);
    return cached.guide != 0u ? cached.light * vec3(0.2, 1.0, 0.2) : cached.light;
}

// Narrower lobes show what the cache does not keep: each direction that light comes from.
const float min_cached_roughness = 0.34;
bool reflects_like_cache(Surface s) { return s.roughness >= min_cached_roughness; }

#endif
