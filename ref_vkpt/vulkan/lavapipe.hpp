// SPDX-License-Identifier: GPL-2.0-or-later
// What CPU drivers make their code of, timed on this processor.
#pragma once

namespace vkpt {

// How long gather instructions take for a table's entries of 16 bytes, by the time of loading the same lane by
// lane: 1.1 to 1.8 on a Sapphire Rapids. The 9 ns that a gather takes where microcode guards it against data sampling
// (docs/notes/cpu-driver.md) would come to 8 or more. Infinite where there are none. Takes 0.1 ms.
double measure_gathers();

} // namespace vkpt
