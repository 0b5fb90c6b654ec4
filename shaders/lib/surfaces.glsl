// SPDX-License-Identifier: GPL-2.0-or-later
// From what a ray hit to a surface that can be shaded.
#ifndef VKPT_LIB_SURFACES
#define VKPT_LIB_SURFACES

#include "../shared/liquid.h"
#include "bsdf.glsl"
#include "footprint.glsl"
#include "light_lists.glsl"
#include "material_maps.glsl"
#include "packing.glsl"
#include "sky.glsl"
#include "trace.glsl"

struct HitSurface {
    Surface surface;
    vec3 emission; // radiance towards the viewer
    float opacity;
    uint flags; // MATERIAL_*
    int emitter; // >= 0: its emission is in the light lists
    int cluster; // -1: outside of the map
    float front; // 1: met from its front
    int face; // Triangle::face
    uint medium; // Triangle::medium
};

// A little off the surface, so that rays leaving it do not meet it again: more where coordinates are coarser.
vec3 offset_ray_origin(vec3 position, vec3 normal)
{
    vec3 size = abs(position);
    return position + normal * (0.02 + 4e-6 * quick_max3(size));
}

LightTables light_tables()
{
    LightTables tables;
    tables.emitters = EmitterBuffer(frame.scene.emitters);
    tables.packed_lights = PackedLightBuffer(frame.scene.packed_lights);
    tables.lists = LightListBuffer(frame.scene.light_lists);
    tables.static_indices = LightIndexBuffer(frame.scene.static_light_indices);
    tables.dynamic_indices = LightIndexBuffer(frame.scene.dynamic_light_indices);
#define VKPT_SAMPLER_TABLE(name, type, alignment) tables.name = SamplerTable_##name(frame.scene.sampler_tables.name);
#include "../shared/sampler_tables.def"
    tables.lightstyles = LightstyleBuffer(frame.scene.lightstyles);
    tables.tree = BspTreeBuffer(frame.scene.bsp_tree);
    tables.list_count = frame.scene.light_list_count;
    tables.tree_lights = frame.scene.light_tree_lights;
    return tables;
}

float lightstyle_scale(uint lightstyle) { return LightstyleBuffer(frame.scene.lightstyles).v[lightstyle]; }

// Liquids wobble: the texture is displaced along each axis by a sine of the other.
vec2 warp_uv(vec2 uv) { return uv + WARP_AMPLITUDE * sin(uv.yx * WARP_FREQUENCY + frame.time * WARP_SPEED); }

// How textures are read, at the level of detail that the ray's footprint asks for.
const int TEXTURE_SMOOTH = 0; // over the footprint's ellipse, between texels
const int TEXTURE_TEXEL = 1; // one texel: enough for bounces, where what is sharp is noise among other noise

uvec2 texture_size(Material material) { return split_halves(material.texture_size); }

// The mean over the footprint; of texels that are larger than it the nearest one, where the player wants to see them
// (gl_texturemode).
vec4 sample_texture(uint slot, vec2 uv, Footprint footprint)
{
    if ((frame.flags & FRAME_NEAREST_TEXELS) != 0u && footprint.mip <= 0.0)
        return textureLod(VKPT_TEXTURE(slot, SAMPLER_REPEAT_NEAREST), uv, 0.0);
    vec2 step = footprint.axis / footprint.taps;
    uv -= step * (0.5 * (footprint.taps - 1.0));
    vec4 sum = vec4(0.0);
    ROLLED_FOR (float tap = 0.0; tap < footprint.taps; tap++)
        sum += textureLod(VKPT_TEXTURE(slot, SAMPLER_REPEAT), uv + step * tap, footprint.mip);
    return sum / footprint.taps;
}

vec4 fetch_texel(Material material, vec2 uv, float mip)
{
    uvec2 first = texture_size(material);
    int level = clamp(whole_to_int(floor(mip + 0.5)), 0, findMSB(max(first.x, first.y)));
    ivec2 size = ivec2(max(first >> uint(level), 1u));
    ivec2 texel = clamp(whole_to_int(floor(fract(uv) * vec2(size))), ivec2(0), size - 1);
    return texelFetch(VKPT_TEXTURE(material.texture, SAMPLER_REPEAT), texel, level);
}

// How much of a particle covers what is behind: all within 0.4 of its width, nothing at its rim. The engine's OpenGL 3
// renderer has the same curve, with its fade of 1.2.
float particle_cover(vec2 uv, uint flags)
{
    vec2 place = uv * 2.0 - 1.0;
    return (flags & MATERIAL_SQUARE) != 0u ? 1.0 : quick_clamp(1.2 * (1.0 - dot(place, place)), 0.0, 1.0);
}

// `footprint`: of the texture, whose alpha is `alpha`; the rest as in fetch_surface and apply_normal_map.
void read_normal_map(
    Material material, vec4 tangent, vec2 uv, Footprint footprint, int way, float alpha, float facing, inout Surface s)
{
    if ((material.flags & MATERIAL_ROUGHNESS_IN_ALPHA) != 0u)
        s.roughness = quick_max(s.roughness, alpha);
    footprint.mip = normal_map_mip(material, footprint.mip);
    vec4 texel = way == TEXTURE_TEXEL
        ? textureLod(VKPT_TEXTURE(normal_map(material), SAMPLER_REPEAT_NEAREST), uv, footprint.mip)
        : sample_texture(normal_map(material), uv, footprint);
    apply_normal_map(unpack_normal_texel(texel, bump_scale(material)), tangent, material.flags, facing, s);
}

// Over the footprint's longer axis: what glows need not be sharp.
vec3 read_emissive_map(Material material, vec2 uv, Footprint footprint)
{
    float mip = emissive_map_mip(material, footprint.mip + log2(footprint.taps));
    return textureLod(VKPT_TEXTURE(emissive_map(material), SAMPLER_REPEAT), uv, mip).rgb;
}

// `cone_width`: the ray's footprint there, in units. `way`: TEXTURE_*. Maps beside the texture count where the shader
// has defined VKPT_NORMAL_MAPS.
HitSurface fetch_surface(RawHit hit, Ray ray, float cone_width, int way)
{
    Triangle triangle = fetch_Triangle(frame.scene.triangles, hit.triangle);
    Material material = fetch_Material(frame.scene.materials, triangle.material);
    vec2 b = hit.barycentrics;
    float b0 = 1.0 - b.x - b.y;

    HitSurface result;
    Surface s;
    // From the corners, not along the ray: the error then does not grow with the distance.
    s.position = triangle.positions[0] * b0 + triangle.positions[1] * b.x + triangle.positions[2] * b.y;
    s.view = -ray.direction;
    s.geometric_normal = normalize(
        cross(triangle.positions[1] - triangle.positions[0], triangle.positions[2] - triangle.positions[0]));
    result.front = hit.front != 0u ? 1.0 : 0.0;
    float facing = hit.front != 0u ? 1.0 : -1.0;
    s.geometric_normal *= facing;
    s.normal = normalize(unpack_direction(triangle.normals[0]) * b0 + unpack_direction(triangle.normals[1]) * b.x
                   + unpack_direction(triangle.normals[2]) * b.y)
        * facing;

    vec2 uv = interpolate_uv(triangle, b) + material.uv_scroll;
    if ((material.flags & MATERIAL_WARP) != 0u)
        uv = warp_uv(uv);
    vec2 size = vec2(ivec2(texture_size(material)));
    Footprint footprint = way == TEXTURE_TEXEL
        ? Footprint(vec2(0.0), 1.0, choose_mip(triangle, size, cone_width, dot(s.geometric_normal, s.view)))
        : find_footprint(triangle, size, cone_width, s.geometric_normal, ray.direction, frame.texture_taps);
#ifdef VKPT_NORMAL_MAPS
    vec4 tangent = vec4(0.0); // now: the triangle then takes no registers while textures are read
    if (normal_map(material) != 0u)
        tangent = find_tangent(triangle, s.normal * facing);
#endif
    vec4 texel = way == TEXTURE_TEXEL ? fetch_texel(material, uv, footprint.mip)
                                      : sample_texture(material.texture, uv, footprint);

    s.albedo = quick_clamp(texel.rgb * material.tint, 0.0, 1.0);
    s.roughness = material.roughness;
    s.metallic = material.metallic;
    s.coat_loss = float((material.flags >> MATERIAL_COAT_SHIFT) & MATERIAL_COAT_ONE) / float(MATERIAL_COAT_ONE);
#ifdef VKPT_NORMAL_MAPS
    if (normal_map(material) != 0u)
        read_normal_map(material, tangent, uv, footprint, way, texel.a, facing, s);
#endif
    result.surface = s;
    vec3 glow = texel.rgb;
    if (emissive_map(material) != 0u)
        glow = read_emissive_map(material, uv, footprint);
    result.emission = material.emission * glow * lightstyle_scale(triangle.lightstyle) * result.front;
    result.opacity = material.opacity;
    if ((material.flags & MATERIAL_PARTICLE) != 0u)
        result.opacity *= particle_cover(uv, material.flags);
    result.flags = material.flags;
    result.emitter = triangle.emitter;
    result.face = triangle.face;
    result.medium = triangle.medium;
    result.cluster = triangle.cluster >= 0
        ? triangle.cluster
        : find_cluster(BspTreeBuffer(frame.scene.bsp_tree), offset_ray_origin(s.position, s.geometric_normal));
    return result;
}

// 16 bits: `metallic` in 11, below it `coat_loss` as it is in Material::flags.
const float metallic_one = 2047.0;
uint pack_metal_and_coat(Surface s)
{
    return uint(s.metallic * metallic_one + 0.5) << 5u | uint(s.coat_loss * float(MATERIAL_COAT_ONE) + 0.5);
}

void unpack_metal_and_coat(uint bits, inout Surface s)
{
    s.metallic = float((bits >> 5u) & 0x7ffu) / metallic_one;
    s.coat_loss = float(bits & MATERIAL_COAT_ONE) / float(MATERIAL_COAT_ONE);
}

// What the light passes read back of the primary surface.
void store_surface(uint pixel, HitSurface hit)
{
    Surface s = hit.surface;
    store_normals(pixel, uvec2(pack_direction(s.normal), pack_direction(s.geometric_normal)));
    store_surface(pixel,
        uvec4(pack_unorm2(s.albedo.xy), pack_unorm2(vec2(s.albedo.z, s.roughness)),
            pack_metal_and_coat(s) | (uint(hit.cluster + 1) << 16u), pack_direction(s.view)));
}

// position.w of pixels without a surface to light.
const float DEPTH_NOTHING = -1.0; // sky, or outside of everything
const float DEPTH_UNLIT = -2.0; // a texture that is shown as it is

// What `surface` holds of the material.
void unpack_material(uvec4 bits, inout Surface s)
{
    vec2 blue_roughness = unpack_unorm2(bits.y);
    s.albedo = vec3(unpack_unorm2(bits.x), blue_roughness.x);
    s.roughness = blue_roughness.y;
    unpack_metal_and_coat(bits.z, s);
}

struct PrimarySurface {
    Surface surface;
    float depth; // < 0: no surface
    int cluster;
};

PrimarySurface load_primary_surface(uint pixel)
{
    PrimarySurface result;
    vec4 position = load_position(pixel);
    uvec2 normals = load_normals(pixel);
    uvec4 bits = load_surface(pixel);
    result.depth = position.w;
    result.cluster = int(bits.z >> 16u) - 1;
    result.surface.position = position.xyz;
    result.surface.normal = unpack_direction(normals.x);
    result.surface.geometric_normal = unpack_direction(normals.y);
    result.surface.view = unpack_direction(bits.w);
    unpack_material(bits, result.surface);
    return result;
}

#endif
