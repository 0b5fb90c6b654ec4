// SPDX-License-Identifier: GPL-2.0-or-later
// What the software trace backend's builder (ref_vkpt/rays/bvh.cpp) and its traversal (lib/trace_software.glsl) agree
// on. The layout of nodes and triangles is described in bvh.cpp. GLSL users enable
// GL_EXT_shader_explicit_arithmetic_types_int64 before including this.
#ifndef VKPT_SHARED_TRACE_H
#define VKPT_SHARED_TRACE_H

#include "language.h"

VKPT_SHARED_BEGIN

VKPT_CONST uint BVH_WIDTH = 8u;
VKPT_CONST uint BVH_NODE_BYTES = 96u;
VKPT_CONST uint BVH_FRAME_OFFSET = 48u; // bytes from a node's start
VKPT_CONST uint BVH_CHILD_WORDS_OFFSET = 64u;
// Distance between a node's planes: a positive float's bits >> BVH_STEP_SHIFT, that is its exponent and two bits of
// mantissa.
VKPT_CONST uint BVH_STEP_SHIFT = 21u;
VKPT_CONST uint BVH_STEP_BITS = 10u;
VKPT_CONST uint BVH_TRIANGLE_BYTES = 48u;

// Child word: an inner node's index, or BVH_LEAF | (count - 1) << 27 | first triangle slot.
VKPT_CONST uint BVH_LEAF = 0x80000000u;
VKPT_CONST uint BVH_LEAF_COUNT_SHIFT = 27u;
VKPT_CONST uint BVH_LEAF_COUNT_MASK = 0x78000000u;
VKPT_CONST uint BVH_LEAF_FIRST_MASK = 0x07ffffffu;
VKPT_CONST uint BVH_NO_CHILD = 0x87ffffffu;
VKPT_CONST uint BVH_MAX_LEAF_TRIANGLES = 4u;

// A triangle's last word: id in the low 24 bits, ray mask in the high 8 (as many as Vulkan's own instance mask has).
VKPT_CONST uint BVH_ID_MASK = 0x00ffffffu;
VKPT_CONST uint BVH_RAY_MASK_SHIFT = 24u;

VKPT_CONST uint TRACE_MISS = 0xffffffffu; // triangle id of a ray that met nothing

// The traversal stack: every lane has TRACE_STACK_ENTRIES entries of 8 bytes. build_bvh() guarantees that no ray needs
// more, whatever the triangles. Lanes are interleaved in groups of TRACE_STACK_INTERLEAVE so that neighbours share
// cache lines; a buffer for n lanes has round_up(n, TRACE_STACK_INTERLEAVE) * TRACE_STACK_BYTES_PER_LANE bytes.
VKPT_CONST uint TRACE_STACK_ENTRIES = 64u;
VKPT_CONST uint TRACE_STACK_INTERLEAVE = 8u;
VKPT_CONST uint TRACE_STACK_BYTES_PER_LANE = 512u; // TRACE_STACK_ENTRIES * 8

// Two trees in one array of nodes and one of triangles (device addresses, 8-byte aligned), searched as one.
struct BvhView {
    uint64_t nodes;
    uint64_t triangles;
    uint root;
    uint other_root; // BVH_NO_CHILD: there is none
};
VKPT_ASSERT_SIZE(BvhView, 24);

// The driver's acceleration structures: an instance's custom index is where its triangles' ids start in one of two
// tables (0: the map's, 1: this frame's), with the table's number in the highest of the 24 bits that Vulkan has for it.
VKPT_CONST uint STRUCTURE_TABLE_SHIFT = 23u;
VKPT_CONST uint STRUCTURE_FIRST_MASK = 0x007fffffu;

VKPT_SHARED_END

#endif
