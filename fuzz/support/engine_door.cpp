// SPDX-License-Identifier: GPL-2.0-or-later
// Stands for exports.cpp, which needs a renderer: what a console command throws is the harness's.
#include "ref_vkpt/engine/exports.hpp"

namespace vkpt {

void run_command(void (*function)()) { function(); }

} // namespace vkpt
