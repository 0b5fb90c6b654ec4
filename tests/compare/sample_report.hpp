// SPDX-License-Identifier: GPL-2.0-or-later
// A small report with numbers of its own, as if something had been measured.
#pragma once

#include "client/compare/report.hpp"

namespace vkpt::tests {

// Two scenes of 8 x 6 pixels: subset R8 and R64, uniform, subset filtered.
client::Report make_sample_report();

} // namespace vkpt::tests
