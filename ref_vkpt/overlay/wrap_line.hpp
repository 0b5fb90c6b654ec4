// SPDX-License-Identifier: GPL-2.0-or-later
// Breaks a line of text that is too long for where it is shown.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vkpt {

// Parts of at most `columns` characters (at least 8), broken at blanks where there are any; all but the first are
// indented by two.
std::vector<std::string> wrap_line(std::string_view line, size_t columns);

} // namespace vkpt
