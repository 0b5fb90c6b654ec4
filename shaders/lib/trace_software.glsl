// SPDX-License-Identifier: GPL-2.0-or-later
// Ray tracing in plain compute: walks the 8-wide BVH that ref_vkpt/rays/bvh.cpp builds (layout described there).
//
// One ray per lane. Measured against the alternatives on the CPU driver: nodes and triangles come as texels
// (texels.glsl), in half the time of 64-bit loads through buffer_reference, which become hardware gathers; a storage
// buffer's become branches (half the speed again); a stack in global memory beats private and shared arrays by 10..30 %
// on incoherent rays (on GPUs it is private: lib/device/lanes.glsl); integer min/max on the float bits spares the
// driver's NaN handling.
//
// Extensions are enabled here, so include this before any declaration. A BvhView that comes straight from push
// constants or from constant places of a uniform buffer is 14 % (camera rays), 7 % (bounces), 4 % (shadow rays) faster
// on that driver than one that is fetched through a pointer or by an index: those are gathers, and gathers are what a
// ray's time goes into.
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
#include "device/lanes.glsl"
#include "device/quick_floats.glsl"
#include "ray.glsl"
#include "device/texels.glsl"

VKPT_TEXELS(bvh_nodes, TEXELS_TREE_NODES)
VKPT_TEXELS(bvh_triangles, TEXELS_TREE_TRIANGLES)
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer BvhWords64 { uint64_t words[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BvhWords32 { uint words[]; };

// `lane` counts over all lanes that are in flight together (for instance the index of the invocation in the dispatch).
uint64_t software_stack(uint64_t stack_buffer, uint lane)
{
    uint group = lane / TRACE_STACK_INTERLEAVE, place = lane % TRACE_STACK_INTERLEAVE;
    return stack_buffer + uint64_t(group) * (TRACE_STACK_BYTES_PER_LANE * TRACE_STACK_INTERLEAVE)
        + uint64_t(place * 8u);
}

// A child's key is its entry distance with its index in the lowest bits: keys of positive floats sort as integers.
const int bvh_key_none = 0x7f7fffff; // above every distance: the largest finite float
const int bvh_key_child_mask = 7;
// From an entry of the stack to the next: a private one counts entries, one in a buffer bytes.
uint bvh_stack_stride() { return has_gpu_lanes ? 1u : TRACE_STACK_INTERLEAVE * 8u; }

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

struct BvhRay {
    vec3 origin, inverse;
    int t_min; // float bits, >= 0
};

BvhRay bvh_ray(vec3 origin, vec3 direction, float t_min)
{
    // A tiny slope for none keeps the slabs' distances finite; the boxes' margin (wide_tree.hpp) covers the difference.
    vec3 slope = mix(direction, vec3(1e-18), lessThan(abs(direction), vec3(1e-18)));
    return BvhRay(origin, 1.0 / slope, max(floatBitsToInt(t_min), 0));
}

// Distance to the 8-bit plane `child` of eight. Through int: the driver has no quick way from unsigned to float.
int bvh_slab(uvec2 planes, int child, float start, float step)
{
    int plane = int((planes[child >> 2] >> (child % 4 * 8)) & 0xffu);
    return floatBitsToInt(fma(float(plane), step, start));
}

// A node's boxes: by axis low planes in the first half, high ones in the second; and their frame.
struct BvhNode {
    uvec4 x, y, z, frame;
};

#define BVH_NODE_TEXEL(i) VKPT_TEXEL(bvh_nodes, 0u, bvh.nodes, BVH_NODE_BYTES, node, i)
BvhNode bvh_load_node(BvhView bvh, uint node)
{
    return BvhNode(BVH_NODE_TEXEL(0u), BVH_NODE_TEXEL(1u), BVH_NODE_TEXEL(2u), BVH_NODE_TEXEL(3u));
}
#undef BVH_NODE_TEXEL

// Distances along the ray from plane to plane.
vec3 bvh_steps(BvhRay ray, uint steps)
{
    const uint mask = ((1u << BVH_STEP_BITS) - 1u) << BVH_STEP_SHIFT;
    uvec3 bits = uvec3(steps) << (BVH_STEP_SHIFT - uvec3(0u, BVH_STEP_BITS, 2u * BVH_STEP_BITS));
    return uintBitsToFloat(bits & mask) * ray.inverse;
}

// Entry distances of the children that the ray meets before t_max, ascending.
void bvh_test_node(BvhRay ray, BvhNode node, int t_max, out int key[8])
{
    // Where the ray goes backwards it enters by the high planes.
    bvec3 backwards = lessThan(floatBitsToInt(ray.inverse), ivec3(0));
    uvec2 near_x = backwards.x ? node.x.zw : node.x.xy, far_x = backwards.x ? node.x.xy : node.x.zw;
    uvec2 near_y = backwards.y ? node.y.zw : node.y.xy, far_y = backwards.y ? node.y.xy : node.y.zw;
    uvec2 near_z = backwards.z ? node.z.zw : node.z.xy, far_z = backwards.z ? node.z.xy : node.z.zw;
    vec3 start = (uintBitsToFloat(node.frame.xyz) - ray.origin) * ray.inverse, step = bvh_steps(ray, node.frame.w);
    // Negative floats are negative integers, so the comparison with t_min >= 0 and the final one hold for them as well;
    // what a NaN gives is either a miss or a needless visit.
    UNROLLED_FOR (int child = 0; child < 8; child++) {
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

#define BVH_TRIANGLE_TEXEL(i) VKPT_TEXEL(bvh_triangles, 0u, bvh.triangles, BVH_TRIANGLE_BYTES, slot, i)
BvhTriangle bvh_load_triangle(BvhView bvh, uint slot)
{
    return BvhTriangle(BVH_TRIANGLE_TEXEL(0u), BVH_TRIANGLE_TEXEL(1u), BVH_TRIANGLE_TEXEL(2u).xy);
}
#undef BVH_TRIANGLE_TEXEL

// A ray as the triangle test sees it: moved to the origin and sheared so that it runs along z, which is its longest
// axis (Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", 2013).
struct BvhShear {
    vec3 origin;
    vec2 slope; // of x and y over z
    float inverse; // 1 / z's part of the direction
    bool x_is_z, z_is_z;
    uint mirror; // sign bit: set where the axes' new order or the ray's way along z turns triangles over
};

BvhShear bvh_shear(vec3 origin, vec3 direction)
{
    vec3 size = abs(direction);
    BvhShear shear;
    shear.origin = origin;
    shear.x_is_z = size.x >= size.y && size.x >= size.z;
    shear.z_is_z = !shear.x_is_z && size.z >= size.y;
    shear.inverse = 1.0 / (shear.x_is_z ? direction.x : (shear.z_is_z ? direction.z : direction.y));
    shear.slope
        = vec2(shear.x_is_z ? direction.y : direction.x, shear.z_is_z ? direction.y : direction.z) * shear.inverse;
    shear.mirror = (floatBitsToUint(shear.inverse) & 0x80000000u) ^ (shear.x_is_z || shear.z_is_z ? 0u : 0x80000000u);
    return shear;
}

vec3 bvh_sheared(BvhShear shear, vec3 corner)
{
    vec3 p = corner - shear.origin;
    float z = shear.x_is_z ? p.x : (shear.z_is_z ? p.z : p.y);
    return vec3((shear.x_is_z ? p.y : p.x) - shear.slope.x * z, (shear.z_is_z ? p.y : p.z) - shear.slope.y * z, z);
}

// An edge's sign depends on nothing but its two corners and the ray, and comes out exactly opposite in the triangle
// that shares it
// ("precise": no product is fused with a sum), so no ray passes between two triangles. Moeller and Trumbore's
// comparison, at best 4 % faster, let 2.6 % of the rays through that were aimed at edges. Two-sided, t in (t_min,
// t_max), edges inclusive.
bool bvh_test_triangle(BvhTriangle triangle, BvhShear shear, int t_min, int t_max, uint ray_mask, inout RawHit hit)
{
    vec4 a = uintBitsToFloat(triangle.a), b = uintBitsToFloat(triangle.b);
    uvec2 e = triangle.c;
    vec3 p0 = bvh_sheared(shear, a.xyz), p1 = bvh_sheared(shear, vec3(a.w, b.xy)),
         p2 = bvh_sheared(shear, vec3(b.zw, uintBitsToFloat(e.x)));

    // Each the weight of the corner opposite the edge, times `area`; all of one sign inside.
    precise vec3 weights = vec3(p1.x * p2.y - p2.x * p1.y, p2.x * p0.y - p0.x * p2.y, p0.x * p1.y - p1.x * p0.y);
    float area = weights.x + weights.y + weights.z, scale = 1.0 / area;
    uint sign = floatBitsToUint(area) & 0x80000000u;
    vec3 inward = uintBitsToFloat(floatBitsToUint(weights) ^ sign);
    float t = dot(vec3(p0.z, p1.z, p2.z), weights) * scale * shear.inverse;
    // NaN is above every t_max or below zero.
    bool meets = inward.x >= 0.0 && inward.y >= 0.0 && inward.z >= 0.0 && floatBitsToInt(t) > t_min
        && floatBitsToInt(t) < t_max && ((e.y >> BVH_RAY_MASK_SHIFT) & ray_mask) != 0u;
    if (meets)
        hit = RawHit(e.y & BVH_ID_MASK, t, weights.yz * scale, (sign ^ shear.mirror) >> 31);
    return meets;
}

#define BVH_CHILD(k) BvhWords32(bvh.nodes + uint64_t(child_words + uint(key[k] & bvh_key_child_mask) * 4u)).words[0]
// Farthest first. Nested, because most nodes have few children in the way and the lanes then skip the rest at once.
#define BVH_PUSH(k)                                                                                                    \
    {                                                                                                                  \
        uvec2 entry = uvec2(uint(key[k]), child_words + uint(key[k] & bvh_key_child_mask) * 4u);                       \
        if (has_gpu_lanes)                                                                                             \
            lane_array[top] = entry;                                                                                   \
        else                                                                                                           \
            BvhWords64(stack + uint64_t(top)).words[0] = pack64(entry);                                                \
        top += bvh_stack_stride();                                                                                     \
    }

// The nearest triangle with t in (t_min, t_max) and (mask & ray_mask) != 0, with `any_hit` the first such triangle
// found; no_hit() without. Every ray ends: zero, infinite and NaN ones meet nothing or something, and read nothing
// outside the trees. `stack`: software_stack() of this lane, which GPUs do not need.
RawHit software_trace(
    BvhView bvh, vec3 origin, vec3 direction, float t_min, float hit_max, uint ray_mask, bool any_hit, uint64_t stack)
{
    RawHit hit = no_hit(hit_max);
    BvhRay ray = bvh_ray(origin, direction, t_min);
    BvhShear shear = bvh_shear(origin, direction);
    int t_max = min(floatBitsToInt(hit_max), bvh_key_none & ~bvh_key_child_mask);
    uint current = bvh.root, next_root = bvh.other_root, top = 0u;
    for (;;) {
        if (int(current) >= 0) {
            uint child_words = current * BVH_NODE_BYTES + BVH_CHILD_WORDS_OFFSET;
            int key[8];
            bvh_test_node(ray, bvh_load_node(bvh, current), t_max, key);
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
                current = BVH_CHILD(0);
            else
                current = BVH_NO_CHILD;
        }
        if (int(current) < 0 && current != BVH_NO_CHILD) {
            if (bvh_test_triangle(
                    bvh_load_triangle(bvh, current & BVH_LEAF_FIRST_MASK), shear, ray.t_min, t_max, ray_mask, hit)) {
                t_max = floatBitsToInt(hit.t);
                if (any_hit)
                    break;
            }
            bool more = (current & BVH_LEAF_COUNT_MASK) != 0u;
            current = more ? current - (1u << BVH_LEAF_COUNT_SHIFT) + 1u : BVH_NO_CHILD;
        }
        if (current == BVH_NO_CHILD) {
            if (top == 0u) {
                if (next_root == BVH_NO_CHILD)
                    break;
                current = next_root;
                next_root = BVH_NO_CHILD;
            } else {
                top -= bvh_stack_stride();
                uvec2 entry = has_gpu_lanes ? lane_array[top] : unpack32(BvhWords64(stack + uint64_t(top)).words[0]);
                if (int(entry.x) < t_max)
                    current = BvhWords32(bvh.nodes + uint64_t(entry.y)).words[0];
            }
        }
    }
    return hit;
}

#undef BVH_PUSH
#undef BVH_CHILD

#endif
