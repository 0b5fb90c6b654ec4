// SPDX-License-Identifier: GPL-2.0-or-later
// The page docs/passes.md, from the rows of shaders/passes.def.
#pragma once

#include <string>

namespace vkpt::client {

std::string make_pass_page();

} // namespace vkpt::client
