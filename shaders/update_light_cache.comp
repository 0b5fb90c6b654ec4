#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-License-Identifier: GPL-2.0-or-later
// Takes samples of the light that arrives at some of the light cache's cells: a random point of the face in the cell,
// one light, one shadow ray.
#define VKPT_ALWAYS_SUBSET_PPS
#include "lib/frame.glsl"
#include "lib/light_cache.glsl"
#include "lib/lighting.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer CacheCornerBuffer { vec2 v[]; };

CacheFacePlane load_cache_plane(uint face)
{
    uint64_t address = frame.scene.cache.planes + uint64_t(face * 64u);
    uvec4 a = load_element(address, 0u, uvec4(0u)), b = load_element(address, 1u, uvec4(0u)),
          c = load_element(address, 2u, uvec4(0u)), d = load_element(address, 3u, uvec4(0u));
    return CacheFacePlane(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz), int(c.w),
        uintBitsToFloat(d.xyz), d.w);
}

// Of the sequence of a cell: multiples of powers of the root of x^6 = x + 1 (Roberts 2018), turned by a hash of cell
// and dimension. The points of a cell are spread evenly, those of neighbours are independent.
float cell_number(uint cell, uint sample_number, uint dimension)
{
    const uint steps[5] = uint[5](0xe19b01aau, 0xc6d1d6c8u, 0xaf36d01eu, 0x9a69443eu, 0x881403b9u); // of 2^32
    uint offset = hash_pcg4(uvec4(cell, dimension, frame.seed, 0x6361636bu)).x;
    return uint_to_unit_float(offset + sample_number * steps[dimension]);
}

// Whether a place in a face, in cells, lies within its outline, which is convex and turns left.
bool is_in_face(CacheFacePlane plane, vec2 place)
{
    CacheCornerBuffer corners = CacheCornerBuffer(frame.scene.cache.corners + uint64_t(plane.first_corner * 8u));
    vec2 before = corners.v[plane.corner_count - 1u];
    ROLLED_FOR (uint i = 0u; i < plane.corner_count; i++) {
        vec2 corner = corners.v[i], edge = corner - before, way = place - before;
        if (edge.x * way.y - edge.y * way.x < 0.0)
            return false;
        before = corner;
    }
    return true;
}

// A few tries, then the middle of what the face has of the cell.
vec2 place_in_cell(CacheFacePlane plane, vec2 cell, vec2 middle, vec2 xi)
{
    const uint tries = 4u;
    ROLLED_FOR (uint i = 0u; i < tries; i++) {
        vec2 place = cell + recurrent_place(xi, i);
        if (is_in_face(plane, place))
            return place;
    }
    return cell + middle;
}

// What one sample found.
struct SampledLight {
    vec3 light;
    vec3 direction;
    float power; // schlick_power of its angle
};

// Three floats without sign and their lowest ten bits.
uvec2 pack_light(vec3 light)
{
    uvec3 bits = (floatBitsToUint(light) + 512u) >> 10u;
    return uvec2(bits.x | (bits.y << 21u), (bits.y >> 11u) | (bits.z << 10u));
}

// Directions and powers have few bits, and change little by little: they are rounded up or down by chance (xi).
uint pack_cached_direction(vec3 direction, vec3 xi)
{
    uvec3 d = uvec3(quick_clamp(direction * 511.0 + 512.0, 1.0, 1023.0) + xi);
    return min(d.x, 1023u) | min(d.y, 1023u) << 10u | min(d.z, 1023u) << 20u;
}

// What the newest sample has of a mean that is weighed by luminance; `share`: of the samples.
float share_of_newest(vec3 before, vec3 found, float share)
{
    float old_weight = luminance(before) * (1.0 - share), new_weight = luminance(found) * share;
    return new_weight / quick_max(old_weight + new_weight, 1e-20);
}

void add_to_lobe(uint lobe, vec3 light, vec3 direction, float share, vec3 xi)
{
    LightLobe before = load_cache_lobe(lobe);
    vec3 mean = mix(before.direction, direction, share_of_newest(before.light, light, share));
    store_element(frame.scene.cache.lobes, lobe,
        uvec2(pack_rgb9e5(mix(before.light, light, share), xi.yzx), pack_cached_direction(mean, xi)));
}

void add_sample(CacheFace face, uint value, SampledLight found, vec4 xi)
{
    LightOfStyle before = load_cache_value(value);
    float share = 1.0 / float(min(before.count + 1u, CACHE_MAX_SAMPLES));
    float new_share = share_of_newest(before.light, found.light, share);
    float power = mix(before.power, found.power, new_share);
    uint last = min(before.count + 1u, CACHE_COUNT_MASK) | min(uint(power * 255.0 + xi.w), 255u) << CACHE_POWER_SHIFT
        | before.guide << CACHE_GUIDE_SHIFT;
    store_element(frame.scene.cache.values, value,
        uvec4(pack_light(mix(before.light, found.light, share)),
            pack_cached_direction(mix(before.direction, found.direction, new_share), xi.xyz), last));
    uint own = lobe_of_direction(face, found.direction);
    ROLLED_FOR (uint i = 0u; i < CACHE_LOBES; i++)
        add_to_lobe(value * CACHE_LOBES + i, i == own ? found.light : vec3(0.0), found.direction, share, xi.xyz);
}

// Whether the point lies inside of something closed that stands on the face: straight up from there its inner side is
// met.
bool is_covered(Surface s)
{
    RawHit hit = trace_nearest(Ray(offset_ray_origin(s.position, s.normal), s.normal, 0.0, ray_far), mask_shadow);
    return hit.triangle != TRACE_MISS && hit.front == 0u;
}

// A matte white one.
Surface surface_at(CacheFacePlane plane, vec2 place)
{
    Surface s;
    s.position = plane.origin + plane.across * place.x + plane.down * place.y;
    s.normal = s.geometric_normal = s.view = plane.normal;
    s.albedo = vec3(1.0);
    s.roughness = 1.0;
    s.metallic = 0.0;
    s.coat_loss = 0.0;
    return s;
}

void sample_cell(CacheCell cell, CacheFace face, CacheFacePlane plane, uint sample_number)
{
    uvec2 cells = cache_face_cells(face);
    uint layers = cache_face_layers(face), number = (cell.first_value - face.first_value) / layers;
    vec2 xi = vec2(cell_number(cell.first_value, sample_number, 0u), cell_number(cell.first_value, sample_number, 1u));
    Surface s = surface_at(
        plane, place_in_cell(plane, vec2(number % cells.x, number / cells.x), unpackUnorm2x16(cell.centre), xi));
    int cluster = plane.cluster >= 0
        ? plane.cluster
        : find_cluster(BspTreeBuffer(frame.scene.bsp_tree), offset_ray_origin(s.position, s.geometric_normal));
    uvec2 key = uvec2(cell.first_value & 0xffffu, cell.first_value >> 16u);
    LightRandom random = light_random(make_random(key, sample_number, frame.seed), 0u);
    random.light = cell_number(cell.first_value, sample_number, 2u);
    random.point
        = vec2(cell_number(cell.first_value, sample_number, 3u), cell_number(cell.first_value, sample_number, 4u));
    ChosenLight chosen;
    vec3 light = sample_list(static_lights(open_light_list(light_tables(), cluster)), s, random, false, chosen).diffuse;
    // The cell's mean is over what can be seen of it.
    if (light == vec3(0.0) && is_covered(s))
        return;
    SampledLight found = SampledLight(light, chosen.direction, schlick_power(dot(s.normal, chosen.direction)));
    vec4 rounding
        = vec4(hash_pcg4(uvec4(cell.first_value, sample_number, frame.seed, 1u)) >> 8u) * 5.9604644775390625e-8;
    // A style that is dark now tells nothing of its layer.
    ROLLED_FOR (uint layer = 0u; layer < layers; layer++) {
        uint style = cache_layer_style(face, layer);
        float scale = lightstyle_scale(style);
        if (scale > 0.0) {
            found.light = style == chosen.lightstyle ? light / scale : vec3(0.0);
            add_sample(face, frame.scene.cache.value_count + cell.first_value + layer, found, rounding);
        }
    }
}

void update_cell(uvec2, uint number)
{
    LightCacheView cache = frame.scene.cache;
    if (number >= cache.updated)
        return;
    uint place = cache.first_updated + number, first_sample = cache.first_sample;
    if (place >= cache.cell_count) { // once around
        place -= cache.cell_count;
        first_sample += 1u;
    }
    uvec4 words = load_element(cache.cells, place, uvec4(0u));
    CacheCell cell = CacheCell(words.x, words.y, words.z, words.w);
    CacheFace face = load_cache_face(cell.face);
    CacheFacePlane plane = load_cache_plane(cell.face);
    ROLLED_FOR (uint i = 0u; i < cache.samples; i++)
        sample_cell(cell, face, plane, first_sample + i);
}

VKPT_RUN_OVER_CELLS(update_cell)
