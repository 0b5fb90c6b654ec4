// SPDX-License-Identifier: GPL-2.0-or-later
// What exports.cpp needs from the rest of the module besides renderer.hpp.
#pragma once

#include "ref_vkpt/extension.hpp"

namespace vkpt {

// The table behind the exported symbol "vkpt_extension". Implemented in ref_vkpt/extension.cpp.
const Extension& extension_table();

// Runs a console command's function; what it throws becomes the engine's error, as with every entry point.
void run_command(void (*function)());

} // namespace vkpt
