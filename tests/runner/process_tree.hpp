// SPDX-License-Identifier: GPL-2.0-or-later
// A process with all that it has started: the CPU time they took together, and their end. Limits of tests count CPU
// time, because the clock on the wall also counts what else the machine does.
#pragma once

#include <sys/types.h>

namespace vkpt::tests {

// Seconds, of user and system, of `root` and its descendants; those that have ended count where somebody waited for
// them. 0: there is no such process.
double measure_cpu_seconds(pid_t root);

// Sends the signal to `root` and all its descendants; returns how many got it.
int signal_tree(pid_t root, int signal);
// To the descendants alone.
int signal_descendants(pid_t root, int signal);

} // namespace vkpt::tests
