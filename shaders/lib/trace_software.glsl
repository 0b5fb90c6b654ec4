// SPDX-License-Identifier: GPL-2.0-or-later
// Ray tracing in plain compute: walks the 8-wide BVH that ref_vkpt/trace/bvh.cpp builds (layout described there).
//
// One ray per lane. Measured against the alternatives on the CPU driver: nodes and triangles come as texels (texels.glsl), in half the time
// of 64-bit loads through buffer_reference, which become hardware gathers; a storage buffer's become branches (half the speed
// again); a stack in global memory beats private and
// shared arrays by 10..30 % on incoherent rays; integer min/max on the float bits spares the driver's NaN handling.
//
// Extensions are enabled here, so include this before any declaration. A BvhView that comes straight from push constants or
// from constant places of a uniform buffer is 14 % (camera rays), 7 % (bounces), 4 % (shadow rays) faster on that driver than
// one that is fetched through a pointer or by an index: those are gathers, and gathers are what a ray's time goes into.
#ifndef VKPT_LIB_TRACE_SOFTWARE_GLSL
#define VKPT_LIB_TRACE_SOFTWARE_GLSL

#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "../shared/trace.h"
#include "quick_floats.glsl"
#include "ray.glsl"
#include "texels.glsl"

VKPT_TEXELS(bvh_nodes, TEXELS_TREE_NODES)
VKPT_TEXELS(bvh_triangles, TEXELS_TREE_TRIANGLES)
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer BvhWords64 { uint64_t words[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BvhWords32 { uint words[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer BvhViews { BvhView views[]; };

// `lane` counts over all lanes that are in flight together (for instance the index of the invocation in the dispatch).
uint64_t software_stack(uint64_t stack_buffer, uint lane)
{
    uint group = lane / TRACE_STACK_INTERLEAVE, place = lane % TRACE_STACK_INTERLEAVE;
    return stack_buffer + uint64_t(group) * (TRACE_STACK_BYTES_PER_LANE * TRACE_STACK_INTERLEAVE) + uint64_t(place * 8u);
}

// A child's key is its entry distance with its index in the lowest bits: keys of positive floats sort as integers.
const int bvh_key_none = 0x7f7fffff; // above every distance: the largest finite float
const int bvh_key_child_mask = 7;
const float bvh_edge_slack = 2.4e-7; // two units in the last place of 1
const uint bvh_stack_stride = TRACE_STACK_INTERLEAVE * 8u;

void bvh_order(inout int a, inout int b)
{
    int low = min(a, b);
    b = max(a, b);
    a = low;
}

// Ascending, by a network of 19 exchanges, the fewest that sort eight.
void bvh_sort(inout int key[8])
{
    bvh_order(key[0], key[1]), bvh_order(key[2], key[3]), bvh_order(key[4], key[5]), bvh_order(key[6], key[7]);
    bvh_order(key[0], key[2]), bvh_order(key[1], key[3]), bvh_order(key[4], key[6]), bvh_order(key[5], key[7]);
    bvh_order(key[1], key[2]), bvh_order(key[5], key[6]), bvh_order(key[0], key[4]), bvh_order(key[3], key[7]);
    bvh_order(key[1], key[5]), bvh_order(key[2], key[6]);
    bvh_order(key[1], key[4]), bvh_order(key[3], key[6]);
    bvh_order(key[2], key[4]), bvh_order(key[3], key[5]);
    bvh_order(key[3], key[4]);
}

// A ray in the grid's coordinates.
struct BvhRay {
    vec3 origin, inverse;
    bvec3 backwards; // enters by a node's high planes
    int t_min;       // float bits, >= 0
};

BvhRay bvh_ray(BvhView bvh, vec3 origin, vec3 direction, int t_min)
{
    // A tiny slope for none keeps the slabs' distances finite; the boxes' margin (bvh.cpp) covers the difference.
    vec3 slope = mix(direction, vec3(1e-18), lessThan(abs(direction), vec3(1e-18)));
    vec3 inverse = 1.0 / (slope * bvh.grid_scale);
    return BvhRay((origin - bvh.grid_origin) * bvh.grid_scale, inverse, lessThan(floatBitsToInt(inverse), ivec3(0)), t_min);
}

// Distance to the 8-bit plane `child` of eight. Through int: the driver has no quick way from unsigned to float.
int bvh_slab(uvec2 planes, int child, float start, float step)
{
    int plane = int((planes[child >> 2] >> (child % 4 * 8)) & 0xffu);
    return floatBitsToInt(fma(float(plane), step, start));
}

// A node's boxes: by axis low planes in the first half, high ones in the second; and their frame.
struct BvhNode {
    uvec4 x, y, z;
    uvec2 frame;
};

#define BVH_NODE_TEXEL(i) VKPT_TEXEL(bvh_nodes, bvh.first_node, bvh.nodes, BVH_NODE_BYTES, node, i)
BvhNode bvh_load_node(BvhView bvh, uint node)
{
    return BvhNode(BVH_NODE_TEXEL(0u), BVH_NODE_TEXEL(1u), BVH_NODE_TEXEL(2u), BVH_NODE_TEXEL(3u).xy);
}
#undef BVH_NODE_TEXEL

// Entry distances of the children that the ray meets before t_max, ascending.
void bvh_test_node(BvhRay ray, BvhNode node, int t_max, out int key[8])
{
    uvec2 near_x = ray.backwards.x ? node.x.zw : node.x.xy, far_x = ray.backwards.x ? node.x.xy : node.x.zw;
    uvec2 near_y = ray.backwards.y ? node.y.zw : node.y.xy, far_y = ray.backwards.y ? node.y.xy : node.y.zw;
    uvec2 near_z = ray.backwards.z ? node.z.zw : node.z.xy, far_z = ray.backwards.z ? node.z.xy : node.z.zw;
    uvec2 frame_words = node.frame;
    // Distances to the frame's corner, and from plane to plane.
    vec3 corner = vec3(ivec3(frame_words.x & 0xffffu, frame_words.x >> 16, frame_words.y & 0xffffu));
    vec3 start = (corner - ray.origin) * ray.inverse;
    uvec3 steps = (uvec3(frame_words.y >> 16) >> uvec3(0u, BVH_STEP_BITS, 2u * BVH_STEP_BITS)) & ((1u << BVH_STEP_BITS) - 1u);
    vec3 step = uintBitsToFloat((steps << BVH_STEP_SHIFT) + floatBitsToUint(1.0)) * ray.inverse;
    // Negative floats are negative integers, so the comparison with t_min >= 0 and the final one hold for them as well; what a
    // NaN gives is either a miss or a needless visit.
    [[unroll]] for (int child = 0; child < 8; child++) {
        int enter = max(max(bvh_slab(near_x, child, start.x, step.x), bvh_slab(near_y, child, start.y, step.y)),
            max(bvh_slab(near_z, child, start.z, step.z), ray.t_min));
        int leave = min(min(bvh_slab(far_x, child, start.x, step.x), bvh_slab(far_y, child, start.y, step.y)),
            min(bvh_slab(far_z, child, start.z, step.z), t_max));
        key[child] = enter <= leave ? (enter & ~bvh_key_child_mask) | child : bvh_key_none;
    }
    bvh_sort(key);
}

// Three corners, then id and mask.
struct BvhTriangle {
    uvec4 a, b;
    uvec2 c;
};

#define BVH_TRIANGLE_TEXEL(i) VKPT_TEXEL(bvh_triangles, bvh.first_triangle, bvh.triangles, BVH_TRIANGLE_BYTES, slot, i)
BvhTriangle bvh_load_triangle(BvhView bvh, uint slot)
{
    return BvhTriangle(BVH_TRIANGLE_TEXEL(0u), BVH_TRIANGLE_TEXEL(1u), BVH_TRIANGLE_TEXEL(2u).xy);
}
#undef BVH_TRIANGLE_TEXEL

// Pluecker's edge tests: an edge's sign depends on nothing but its two corners and the ray, and comes out exactly opposite in
// the triangle that shares it, so no ray passes between two triangles. Moeller and Trumbore's comparison, 2 % faster, let
// 2.6 % of the rays through that were aimed at edges. Two-sided, t in (t_min, t_max), edges inclusive.
bool bvh_test_triangle(BvhTriangle triangle, vec3 origin, vec3 direction, int t_min, int t_max, uint ray_mask, inout RawHit hit)
{
    vec4 a = uintBitsToFloat(triangle.a), b = uintBitsToFloat(triangle.b);
    uvec2 e = triangle.c;
    vec3 p0 = a.xyz - origin, p1 = vec3(a.w, b.xy) - origin, p2 = vec3(b.zw, uintBitsToFloat(e.x)) - origin;

    // Each the weight of the corner opposite the edge, times `area`; all of one sign inside.
    vec3 weights = vec3(dot(cross(p1 - p2, p1 + p2), direction), dot(cross(p2 - p0, p2 + p0), direction),
        dot(cross(p0 - p1, p0 + p1), direction));
    float area = weights.x + weights.y + weights.z;
    int sign = floatBitsToInt(area) & 0x80000000;
    vec3 inward = intBitsToFloat(floatBitsToInt(weights) ^ sign);
    // The slack is for rays at a corner, where the signs of several edges must agree.
    float least = -bvh_edge_slack * abs(area);
    if (!(inward.x >= least && inward.y >= least && inward.z >= least) || area == 0.0 || ((e.y >> BVH_RAY_MASK_SHIFT) & ray_mask) == 0u)
        return false;
    vec3 normal = cross(p2 - p0, p0 - p1);
    float slope = dot(normal, direction);
    float t = dot(normal, p0) / slope;
    if (floatBitsToInt(t) <= t_min || floatBitsToInt(t) >= t_max) // NaN is above every t_max or below zero
        return false;
    hit = RawHit(e.y & BVH_ID_MASK, t, quick_max(weights.yz / area, vec2(0.0)), slope < 0.0 ? 1u : 0u);
    return true;
}

#define BVH_PUSH(k)                                                                                                           \
    {                                                                                                                         \
        BvhWords64(stack + uint64_t(top)).words[0]                                                                            \
            = pack64(uvec2(uint(key[k]), child_words + uint(key[k] & bvh_key_child_mask) * 4u));                              \
        top += bvh_stack_stride;                                                                                              \
    }

// Replaces `hit` (at first no_hit()) by the tree's nearest triangle with t in (t_min, hit.t) and (mask & ray_mask) != 0, if there is one; with
// `any_hit` by the first such triangle found. Call it for one tree after the other to search several; for a short compile, in a
// loop, so that the generated code has it once (software_trace_all). Every ray ends: zero, infinite and NaN ones meet nothing
// or something, and read nothing outside the tree. `stack`: software_stack() of this lane.
void software_trace(BvhView bvh, vec3 origin, vec3 direction, float t_min, inout RawHit hit, uint ray_mask, bool any_hit,
    uint64_t stack)
{
    BvhRay ray = bvh_ray(bvh, origin, direction, max(floatBitsToInt(t_min), 0));
    int t_max = min(floatBitsToInt(hit.t), bvh_key_none & ~bvh_key_child_mask);
    uint current = 0u, top = 0u;
    for (;;) {
        if (int(current) >= 0) {
            uint child_words = current * BVH_NODE_BYTES + BVH_CHILD_WORDS_OFFSET;
            int key[8];
            bvh_test_node(ray, bvh_load_node(bvh, current), t_max, key);
            // Farthest first. Nested, because most nodes have few children in the way and the lanes then skip the rest at once.
            if (key[1] < bvh_key_none) {
                if (key[2] < bvh_key_none) {
                    if (key[3] < bvh_key_none) {
                        if (key[4] < bvh_key_none) {
                            if (key[5] < bvh_key_none) {
                                if (key[6] < bvh_key_none) {
                                    if (key[7] < bvh_key_none)
                                        BVH_PUSH(7)
                                    BVH_PUSH(6)
                                }
                                BVH_PUSH(5)
                            }
                            BVH_PUSH(4)
                        }
                        BVH_PUSH(3)
                    }
                    BVH_PUSH(2)
                }
                BVH_PUSH(1)
            }
            if (key[0] < bvh_key_none)
                current = BvhWords32(bvh.nodes + uint64_t(child_words + uint(key[0] & bvh_key_child_mask) * 4u)).words[0];
            else
                current = BVH_NO_CHILD;
        }
        if (int(current) < 0 && current != BVH_NO_CHILD) {
            if (bvh_test_triangle(bvh_load_triangle(bvh, current & BVH_LEAF_FIRST_MASK), origin, direction, ray.t_min, t_max, ray_mask, hit)) {
                t_max = floatBitsToInt(hit.t);
                if (any_hit)
                    break;
            }
            bool more = (current & BVH_LEAF_COUNT_MASK) != 0u;
            current = more ? current - (1u << BVH_LEAF_COUNT_SHIFT) + 1u : BVH_NO_CHILD;
        }
        if (current == BVH_NO_CHILD) {
            if (top == 0u)
                break;
            top -= bvh_stack_stride;
            uvec2 entry = unpack32(BvhWords64(stack + uint64_t(top)).words[0]);
            if (int(entry.x) < t_max)
                current = BvhWords32(bvh.nodes + uint64_t(entry.y)).words[0];
        }
    }
}

// The nearest hit (with `any_hit`: some hit) over `tree_count` trees: `first`, and those whose BvhView stand in a row at `more`.
RawHit software_trace_all(BvhView first, uint64_t more, uint tree_count, vec3 origin, vec3 direction, float t_min, float t_max,
    uint ray_mask, bool any_hit, uint64_t stack)
{
    RawHit hit = no_hit(t_max);
    [[dont_unroll]] for (uint tree = 0u; tree < tree_count; tree++) {
        BvhView view = first;
        if (tree > 0u)
            view = BvhViews(more).views[tree - 1u];
        software_trace(view, origin, direction, t_min, hit, ray_mask, any_hit, stack);
        if (any_hit && hit.triangle != TRACE_MISS)
            break;
    }
    return hit;
}

#undef BVH_PUSH

#endif
