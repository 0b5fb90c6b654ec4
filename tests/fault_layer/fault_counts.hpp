// SPDX-License-Identifier: GPL-2.0-or-later
// What the layer of faults has seen since the newest instance was made.
#pragma once

#include <cstdint>

namespace vkpt::tests {

struct FaultCounts {
    uint64_t hidden_bytes = 0; // allocated out of the CPU's sight, with the fault "gpu"; also what was freed again
    uint32_t refused_allocations = 0; // of memory that both see
    uint32_t submissions = 0, submissions_before_acquire = 0; // of all; of them before the last picture was acquired
    uint32_t acquired = 0, presented = 0, swapchains = 0;
    uint32_t timestamps = 0; // recorded
    uint32_t losses = 0; // of the device
    // With the fault "async": submissions to the second queue; of them those that waited for nothing while a frame of
    // the first queue had not been waited for; and frames that waited for one.
    uint32_t async_submissions = 0, async_beside_a_frame = 0, frames_after_async = 0;
    bool lists_portable = false, enables_portable = false; // portability: asked of the instance, of the device
};

// The layer's "vkpt_fault_counts".
using GetFaultCounts = void (*)(FaultCounts*);

} // namespace vkpt::tests
