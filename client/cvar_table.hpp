// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace vkpt::client {

// All console variables as the Markdown page docs/cvars.md.
std::string make_cvar_page();

} // namespace vkpt::client
