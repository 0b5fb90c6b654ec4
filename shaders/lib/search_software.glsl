// SPDX-License-Identifier: GPL-2.0-or-later
// Backend "software": our own trees, walked in plain compute.
#ifndef VKPT_LIB_SEARCH_SOFTWARE
#define VKPT_LIB_SEARCH_SOFTWARE

#include "alpha_test.glsl"
#include "trace_software.glsl"

// How many holes in a row a ray passes: more than any scene has, so that the loop ends whatever the driver makes of it.
const uint max_alpha_tests = 256u;

// This lane's stack: TRACE_STACK_ENTRIES entries of 8 bytes, one every TRACE_STACK_INTERLEAVE * 8 bytes. Free for
// others while no ray is traced.
uint64_t lane_stack()
{
    // Not gl_WorkGroupSize: it is only known behind the layout(local_size_x) of the including pass, and 1 before it.
    uint lane = gl_WorkGroupID.x * PIXEL_GROUP_SIZE + gl_LocalInvocationID.x;
    return software_stack(frame.scene.trace_stack, lane);
}

// The nearest triangle (with any_hit: some triangle) of the masked ones, alpha taken for opaque.
RawHit search_trees(Ray ray, uint mask, bool any_hit)
{
    BvhView trees = frame.scene.trees;
    if (mask == MASK_FILTER) {
        trees.root = frame.scene.filter_root;
        trees.other_root = frame.scene.other_filter_root;
    }
    return software_trace(trees, ray.origin, ray.direction, ray.t_min, ray.t_max, mask, any_hit, lane_stack());
}

// One call of the traversal, whatever there is to do: it is most of what the CPU driver has to compile. Behind a hole
// the search goes on from exactly there: the same triangle at the same distance is outside of the open interval.
RawHit search_ray(Ray ray, uint mask, bool any_hit)
{
    bool test_alpha = (frame.flags & FRAME_ALPHA_TEST) != 0u;
    RawHit hit;
    ROLLED_FOR (uint i = 0u; i < max_alpha_tests; i++) {
        hit = search_trees(ray, mask, any_hit && !test_alpha);
        if (!test_alpha || hit.triangle == TRACE_MISS || !is_cut_out(hit.triangle, hit.barycentrics))
            break;
        ray.t_min = hit.t;
    }
    return hit;
}

#endif
