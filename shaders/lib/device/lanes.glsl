// SPDX-License-Identifier: GPL-2.0-or-later
// What lanes do in one way on GPUs and in another on the CPU driver (DeviceTraits::gpu_lanes).
//                       GPUs                                    CPU driver
//   a lane's array      private                                 in a buffer: it writes a private one lane by lane
//   loads of 16 bytes   at once                                 as two of 8, which it makes gathers of
//   a workgroup         one tile of 8 x 8 pixels: many small    PIXEL_TILES_PER_GROUP: starting one costs as much as a
//                       ones keep the device busy to the end    cheap pass over a tile
#ifndef VKPT_LIB_LANES
#define VKPT_LIB_LANES

#include "../../shared/specialization.h"
#include "../../shared/trace.h"

layout(constant_id = GPU_LANES_CONSTANT) const bool has_gpu_lanes = false;

// With has_gpu_lanes: the stack of the ray that is traced; free for others while none is. One array for all. Mesa's
// driver for AMD keeps arrays of up to 256 bytes in registers, through all rays, and drops words that nobody reads:
// with another entry than the stack needs, the first words alone are more.
uvec2 lane_array[TRACE_STACK_ENTRIES + 1u];

#endif
