// SPDX-License-Identifier: GPL-2.0-or-later
// The console command `mat`: what is under the crosshair is made of, and changing it.
#pragma once

namespace vkpt {

struct Module;

// `mat`, `mat ATTRIBUTE VALUE`, `mat reset`, `mat save`.
void run_material_command(Module& module);

} // namespace vkpt
