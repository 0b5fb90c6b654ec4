// SPDX-License-Identifier: GPL-2.0-or-later
// The lists of names in ModuleInfo, which end with a null pointer.
#pragma once

#include <string>
#include <vector>

namespace vkpt::client {

// A null list is an empty one.
inline std::vector<std::string> list_names(const char* const* names)
{
    std::vector<std::string> list;
    for (; names && *names; names++)
        list.emplace_back(*names);
    return list;
}

} // namespace vkpt::client
