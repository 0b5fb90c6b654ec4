// SPDX-License-Identifier: GPL-2.0-or-later
// The module's own times, sorted into frames, passes and tasks of the CPU.
#pragma once

#include "common/bench_result.hpp"
#include "ref_vkpt/extension.hpp"

namespace vkpt::client {

// Appends those since the last forget_times(). Waits for the device.
void add_collected_times(const Extension& extension, BenchResult& result);
// Memory that the module has on the device.
double find_device_mib(const ModuleInfo& info);

} // namespace vkpt::client
