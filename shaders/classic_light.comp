#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// The part of the image that pt_wipe shows as the classic game did: the map's baked lightmaps in place of paths, and on
// them what the engine's OpenGL 3 renderer (gl3) makes of dynamic lights. The passes behind find nothing left to light
// there.
#include "lib/dlights.glsl"
#include "lib/surfaces.glsl"

const float lightmap_one = 128.0; // value that makes a white surface's radiance 1
const float light_without_map = 1.0; // of faces and places that have no lightmap
const uint max_models_below = 6u; // that a ray down passes

// gl3's: a surface is lit within a light's intensity less dlight_margin, as if the light stood dlight_lift farther off
// it.
const float dlight_margin = 52.0, dlight_lift = 32.0;

LightmapFace load_lightmap_face(uint face)
{
    uint64_t address = frame.scene.lightmap_faces + uint64_t(face * 32u);
    vec4 a = uintBitsToFloat(load_element(address, 0u, uvec4(0u)));
    uvec4 b = load_element(address, 1u, uvec4(0u));
    return LightmapFace(a.xy, a.zw, b.x, b.y, b.z, b.w);
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

// Irradiance / pi at a place of a face.
vec3 baked_light(LightmapFace map, vec2 uv)
{
    if (map.size == 0u)
        return vec3(light_without_map);
    uvec2 size = split_halves(map.size);
    vec3 sum = vec3(0.0);
    ROLLED_FOR (uint i = 0u; i < 4u; i++) {
        uint style = (map.styles >> (8u * i)) & 0xffu;
        if (style == 255u)
            break;
        sum += lightstyle_scale(style) * mix_luxels(map.first + i * size.x * size.y, size, uv * map.scale + map.offset);
    }
    return sum / lightmap_one;
}

// Without shadows. The light of models has no direction.
vec3 dynamic_light(Surface s, bool on_lightmap)
{
    vec3 sum = vec3(0.0);
    ROLLED_FOR (uint i = 0u; i < frame.dlight_count; i++) {
        Dlight light = DlightBuffer(frame.dlights).v[i];
        vec3 to_light = light.origin - s.position;
        float strength = light.intensity - length(to_light);
        if (on_lightmap) {
            bool in_front = dot(to_light, s.geometric_normal) >= 0.0;
            vec3 direction = normalize(to_light + s.geometric_normal * dlight_lift);
            strength = in_front ? (strength - dlight_margin) * dot(direction, s.geometric_normal) : 0.0;
        }
        sum += light.colour * quick_max(strength, 0.0);
    }
    return sum;
}

// Of the map's face that the surface lies on, wherever that has moved; of other things, that of the world's floor
// below, as the classic renderers light models.
vec3 find_classic_light(Surface s)
{
    const float within = 0.5;
    vec3 light = vec3(light_without_map);
    bool on_lightmap = false;
    Ray ray = Ray(s.position + s.geometric_normal * within, -s.geometric_normal, 0.0, 2.0 * within);
    ROLLED_FOR (uint i = 0u; i < max_models_below; i++) {
        RawHit hit = trace_nearest(ray, MASK_OPAQUE | MASK_ALPHA_TEST | MASK_TRANSLUCENT);
        if (hit.triangle != TRACE_MISS) {
            Triangle triangle = fetch_Triangle(frame.scene.triangles, hit.triangle);
            if (triangle.face > 0 || (triangle.face < 0 && i == 0u)) {
                LightmapFace map = load_lightmap_face(uint(abs(triangle.face)) - 1u);
                on_lightmap = i == 0u;
                light = baked_light(map, interpolate_uv(triangle, hit.barycentrics));
                if (on_lightmap && map.size == 0u)
                    return light;
                break;
            }
        }
        if (hit.triangle == TRACE_MISS && i > 0u)
            break;
        ray = i == 0u ? Ray(s.position, vec3(0.0, 0.0, -1.0), 0.0, ray_far)
                      : Ray(ray.origin, ray.direction, hit.t, ray_far);
    }
    return max(light + dynamic_light(s, on_lightmap), vec3(0.0));
}

void light_pixel(uvec2 pixel, uint index)
{
    if (float(pixel.x) + 0.5 > frame.cvars.pt_wipe * float(frame.size.x))
        return;
    PrimarySurface primary = load_primary_surface(index);
    if (primary.depth < 0.0)
        return;
    vec3 light = find_classic_light(primary.surface) * primary.surface.albedo;
    vec3 emitted = unpack_floats3(load_emitted(index)) + unpack_light3(load_throughput(index)) * light;
    store_emitted(index, pack_floats3(emitted));
    store_position(index, vec4(primary.surface.position, DEPTH_UNLIT));
    add_traced_rays(index);
}

VKPT_RUN_OVER_PIXELS(light_pixel)
