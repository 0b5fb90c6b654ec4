#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The part of the image that pt_wipe shows as the classic game did: the map's baked lightmaps in place of paths. The
// passes behind find nothing left to light there.
#include "lib/frame.glsl"
#include "lib/surfaces.glsl"

const float lightmap_one = 128.0; // value that makes a white surface's radiance 1
const float light_without_map = 1.0; // of faces and places that have no lightmap
const uint max_models_below = 6u; // that a ray down passes

LightmapFace load_lightmap_face(uint face)
{
    uint64_t address = frame.scene.lightmap_faces + uint64_t(face * 48u);
    uvec4 a = load_element(address, 0u, uvec4(0u)), b = load_element(address, 1u, uvec4(0u)),
          c = load_element(address, 2u, uvec4(0u));
    return LightmapFace(uintBitsToFloat(a), uintBitsToFloat(b), c.x, c.y, c.z, c.w);
}

vec3 load_luxel(uint index)
{
    uint bits = load_element(frame.scene.luxels, index, 0u);
    return vec3(ivec3(uvec3(bits, bits >> 8u, bits >> 16u) & 0xffu));
}

// Between four luxels of one lightstyle.
vec3 mix_luxels(uint first, uvec2 size, vec2 place)
{
    vec2 at = clamp(place, vec2(0.0), vec2(size) - 1.0);
    uvec2 corner = uvec2(ivec2(floor(at))), next = min(corner + 1u, size - 1u);
    vec2 part = fract(at);
    return mix(
        mix(load_luxel(first + corner.y * size.x + corner.x), load_luxel(first + corner.y * size.x + next.x), part.x),
        mix(load_luxel(first + next.y * size.x + corner.x), load_luxel(first + next.y * size.x + next.x), part.x),
        part.y);
}

// Irradiance / pi at a point of a face.
vec3 baked_light(uint face, vec3 position)
{
    LightmapFace map = load_lightmap_face(face);
    uvec2 size = split_halves(map.size);
    if (map.size == 0u)
        return vec3(light_without_map);
    vec2 place = vec2(dot(position, map.across.xyz) + map.across.w, dot(position, map.down.xyz) + map.down.w);
    vec3 sum = vec3(0.0);
    ROLLED_FOR (uint i = 0u; i < 4u; i++) {
        uint style = (map.styles >> (8u * i)) & 0xffu;
        if (style == 255u)
            break;
        sum += lightstyle_scale(style) * mix_luxels(map.first + i * size.x * size.y, size, place);
    }
    return sum / lightmap_one;
}

// Of the map's face that the surface lies on; of what moves, that of the floor below, as the classic renderers light
// models.
vec3 find_baked_light(Surface s)
{
    const float within = 0.5;
    Ray ray = Ray(s.position + s.geometric_normal * within, -s.geometric_normal, 0.0, 2.0 * within);
    ROLLED_FOR (uint i = 0u; i < max_models_below; i++) {
        RawHit hit = trace_nearest(ray, MASK_OPAQUE | MASK_ALPHA_TEST | MASK_TRANSLUCENT);
        if (hit.triangle != TRACE_MISS) {
            uint face = fetch_Triangle(frame.scene.triangles, hit.triangle).cache_face;
            if (face != 0u)
                return baked_light(face - 1u, ray.origin + ray.direction * hit.t);
        }
        if (hit.triangle == TRACE_MISS && i > 0u)
            break;
        ray = i == 0u ? Ray(s.position, vec3(0.0, 0.0, -1.0), 0.0, ray_far)
                      : Ray(ray.origin, ray.direction, hit.t, ray_far);
    }
    return vec3(light_without_map);
}

void light_pixel(uvec2 pixel, uint index)
{
    if (float(pixel.x) + 0.5 > frame.cvars.pt_wipe * float(frame.size.x))
        return;
    PrimarySurface primary = load_primary_surface(index);
    if (primary.depth < 0.0)
        return;
    vec3 light = find_baked_light(primary.surface) * primary.surface.albedo;
    vec3 emitted = unpack_floats3(load_emitted(index)) + unpack_light3(load_throughput(index)) * light;
    store_emitted(index, pack_floats3(emitted));
    store_position(index, vec4(primary.surface.position, DEPTH_UNLIT));
    add_traced_rays(index);
}

VKPT_RUN_OVER_PIXELS(light_pixel)
