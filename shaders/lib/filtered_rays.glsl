// SPDX-License-Identifier: GPL-2.0-or-later
// Rays that carry light through liquids and glass (MASK_FILTER): they go straight on, and what they carry is coloured.
// Rays that pass none of the few boxes around those faces cost nothing more.
#ifndef VKPT_LIB_FILTERED_RAYS
#define VKPT_LIB_FILTERED_RAYS

#include "device/lanes.glsl"
#include "media.glsl"
#include "surfaces.glsl"

// More surfaces in a row than anybody counts; those of liquids are two faces each.
const uint max_filters = 24u;

// Whether the ray's part between t_min and t_max, which are not negative, meets the box. Distances are compared as
// integers, as in bvh_test_node.
bool meets_box(Ray ray, vec3 inverse, FilterBox box)
{
    bvec3 backwards = lessThan(inverse, vec3(0.0));
    int t_min = floatBitsToInt(ray.t_min), t_max = floatBitsToInt(ray.t_max);
    ivec3 near = floatBitsToInt((mix(box.mins, box.maxs, backwards) - ray.origin) * inverse);
    ivec3 far = floatBitsToInt((mix(box.maxs, box.mins, backwards) - ray.origin) * inverse);
    return max(max(near.x, near.y), max(near.z, t_min)) <= min(min(far.x, far.y), min(far.z, t_max));
}

// Whether something on the ray may colour light. On the CPU driver the loop is unrolled: it then loads a box once for
// all lanes, instead of gathering it for each.
bool meets_filter_box(Ray ray)
{
    vec3 inverse = 1.0 / mix(ray.direction, vec3(1e-18), lessThan(abs(ray.direction), vec3(1e-18)));
    bool meets = false;
    if (has_gpu_lanes) {
        ROLLED_FOR (uint i = 0u; i < frame.scene.filter_box_count; i++)
            meets = meets || meets_box(ray, inverse, frame.scene.filter_boxes[i]);
    } else {
        UNROLLED_FOR (uint i = 0u; i < MAX_FILTER_BOXES; i++) {
            bool meets_this = meets_box(ray, inverse, frame.scene.filter_boxes[i]);
            meets = meets || meets_this;
        }
    }
    return meets;
}

// Lines of light, by the kernel of Poisson's integral: its mean over a period is 1, whatever the sharpness.
float caustic_lines(vec2 place, vec3 lines, vec3 bends, float sharpness)
{
    float bend = CAUSTIC_BEND * sin(dot(place, bends.xy) + bends.z * frame.time);
    float phase = dot(place, lines.xy) + lines.z * frame.time + bend;
    return (1.0 - sharpness * sharpness) / (1.0 + sharpness * sharpness - 2.0 * sharpness * cos(phase));
}

// Of light that reaches a point `depth` below the surface through `place` of it. Its mean over the surface is 1: the
// lines' phases are independent, so that they meet all of each other's values.
float caustics(vec2 place, float depth)
{
    float sharpness = CAUSTIC_SHARPNESS * depth / (depth + CAUSTIC_DEPTH);
    float lines = caustic_lines(place, CAUSTIC_LINES_A, CAUSTIC_BENDS_A, sharpness)
        + caustic_lines(place, CAUSTIC_LINES_B, CAUSTIC_BENDS_B, sharpness)
        + caustic_lines(place, CAUSTIC_LINES_C, CAUSTIC_BENDS_C, sharpness);
    return mix(1.0, lines / 3.0, frame.cvars.pt_caustics);
}

// How far a ray has been followed through what colours it.
struct FilterState {
    vec3 transmittance;
    float passed; // distance of the last surface
    uint medium; // behind it
    bool knows_medium; // one was met
};

void pass_liquid(inout FilterState state, Triangle triangle, Ray ray, RawHit hit)
{
    const float min_depth = 0.1; // between the two faces of a surface is nothing
    uint before = medium_before(triangle.medium, hit.front != 0u);
    float depth = hit.t - state.passed;
    if (before != MEDIUM_NONE && depth > min_depth) {
        state.transmittance *= medium_transmittance(before, depth);
        vec3 edge_a = triangle.positions[1] - triangle.positions[0],
             edge_b = triangle.positions[2] - triangle.positions[0];
        bool lies_flat = abs(normalize(cross(edge_a, edge_b)).z) > 0.7;
        if (before == MEDIUM_WATER && !state.knows_medium && lies_flat && frame.cvars.pt_caustics > 0.0)
            state.transmittance *= caustics((ray.origin + ray.direction * hit.t).xy, depth);
    }
    state.medium = medium_behind(triangle.medium, hit.front != 0u);
    state.passed = hit.t;
    state.knows_medium = true;
}

void pass_filter(inout FilterState state, Ray ray, RawHit hit)
{
    Triangle triangle = fetch_Triangle(frame.scene.triangles, hit.triangle);
    if (triangle.medium != MEDIUM_NONE)
        pass_liquid(state, triangle, ray, hit);
    // A pane has a front on either side, and so have liquids: one of them counts.
    if ((triangle.medium & MEDIUM_MASK) == MEDIUM_WATER || hit.front == 0u)
        return;
    Material material = fetch_Material(frame.scene.materials, triangle.material);
    vec2 uv = interpolate_uv(triangle, hit.barycentrics) + material.uv_scroll;
    if ((material.flags & MATERIAL_WARP) != 0u)
        uv = warp_uv(uv);
    vec3 albedo = quick_clamp(fetch_texel(material, uv, 1.0).rgb * material.tint, 0.0, 1.0);
    state.transmittance *= pane_transmittance(albedo, material.opacity);
}

// The nearest of the masked triangles, with any_hit what is met first by chance; and what is left of light that comes
// along the ray from there, or from its end. With any_hit: 0 where something was met. `visibility`: counted as such.
RawHit trace_filtered(Ray ray, uint mask, bool any_hit, bool visibility, out vec3 transmittance)
{
    RawHit met = no_hit(ray.t_max);
    FilterState state = FilterState(vec3(1.0), 0.0, MEDIUM_NONE, false);
    Ray part = ray;
    // One search for all that is asked, as every call is compiled apart.
    ROLLED_FOR (uint i = 0u; i <= max_filters; i++) {
        bool first = i == 0u;
        count_ray(visibility);
        RawHit hit = search_ray(part, first ? mask : MASK_FILTER, first && any_hit);
        if (first) {
            met = hit;
            part.t_max = hit.t;
            if ((any_hit && hit.triangle != TRACE_MISS) || frame.scene.filter_box_count == 0u
                || !meets_filter_box(part))
                break;
        } else if (hit.triangle != TRACE_MISS) {
            pass_filter(state, ray, hit);
            part.t_min = hit.t;
        } else {
            if (!state.knows_medium)
                state.medium = find_medium(BspTreeBuffer(frame.scene.bsp_tree), ray.origin);
            state.transmittance *= medium_transmittance(state.medium, part.t_max - state.passed);
            break;
        }
    }
    transmittance = any_hit && met.triangle != TRACE_MISS ? vec3(0.0) : state.transmittance;
    return met;
}

#endif
