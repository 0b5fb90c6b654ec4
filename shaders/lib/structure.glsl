// SPDX-License-Identifier: GPL-2.0-or-later
// Triangle ids in the driver's acceleration structures (ref_vkpt/rays/acceleration_structures.cpp).
#ifndef VKPT_LIB_STRUCTURE
#define VKPT_LIB_STRUCTURE

#include "frame.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer IdBuffer { uint v[]; };

// The triangles of a structure are grouped and reordered: an instance's custom index says where its group's ids start,
// and in which of the two tables.
uint triangle_id(uint custom_index, uint primitive)
{
    uint64_t table = frame.scene.structure_ids[custom_index >> STRUCTURE_TABLE_SHIFT];
    return IdBuffer(table).v[(custom_index & STRUCTURE_FIRST_MASK) + primitive];
}

#endif
