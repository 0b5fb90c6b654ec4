// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures from elsewhere against the frames that a run has captured.
#pragma once

#include "tests/engine/engine_run.hpp"

namespace vkpt::tests {

// One of the captured frames is this picture, byte for byte, and it shows something.
void expect_captured(const EngineRun& run, const std::filesystem::path& picture);

} // namespace vkpt::tests
