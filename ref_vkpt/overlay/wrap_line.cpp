// SPDX-License-Identifier: GPL-2.0-or-later
#include "ref_vkpt/overlay/wrap_line.hpp"

#include <algorithm>

namespace vkpt {

std::vector<std::string> wrap_line(std::string_view line, size_t columns)
{
    columns = std::max(columns, size_t(8));
    std::vector<std::string> parts;
    std::string_view indent;
    while (indent.size() + line.size() > columns) {
        const size_t room = columns - indent.size();
        const size_t blank = line.find_last_of(' ', room);
        const size_t end = blank == std::string_view::npos || blank == 0 ? room : blank;
        parts.push_back(std::string(indent) + std::string(line.substr(0, end)));
        line.remove_prefix(line[end] == ' ' ? end + 1 : end);
        indent = "  ";
    }
    parts.push_back(std::string(indent) + std::string(line));
    return parts;
}

} // namespace vkpt
