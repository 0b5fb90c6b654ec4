// SPDX-License-Identifier: GPL-2.0-or-later
// Maps of less than a megabyte that ask for as much work as they can: each drives one loop, or the product of two, as
// far as the file's size allows. Some are refused, some lie just within the limits.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vkpt::test {

struct HostileMap {
    std::string name;
    std::vector<std::byte> file;
    bool is_refused; // else it has to load
};

std::vector<HostileMap> make_hostile_maps();

} // namespace vkpt::test
